# ridgeline: `make demo` and `make test` need rustup's cargo, Node >= 20 and make; the rest is installed
# here, once. Stamps (target/stamps/, www/node_modules/) and the tool cache keep second runs quick.
#
#   make demo       build, serve the page and print its address
#   make test       set up, lint and run every test (native, wasm in Node, TypeScript, Chromium)
#   make build      the static site in www/dist, for any static host
#   make lint       format, counts that may only fall (tests/evaluation/economy.py), unused dependencies, clippy (native and
#                   wasm32), Biome, TypeScript
#   make identical  the demo and the synthetic scenes natively and in wasm, compared byte for byte
#   make golden     rewrite what the tests expect to be found in the synthetic scenes (tests/golden)
#   make score      all scenes against their truth; writes docs/results.md
#   make interrupt  a block under Snakemake, interrupted TIMES (20) at random moments by SEED (1): the same bytes
#   make fuzz       all readers on damaged files, FUZZ_SECONDS (600) for each format
#   make jury       all scenes many times over, changed a little each time; rewrites its tables there
#   make judge      SEEDS (as "518 to 530") of random scenes that chose nothing; BEFORE=PROGRAM compares in pairs, PAGE=1
#                   rewrites the section of docs/results.md
#   make calibrate  fits the tables of src/base/evidence to scenes with truth, PYTHON (python3) with numpy, scipy, shapely, Pillow
#   make bench      time and memory of every stage, against the commit BEFORE in pairs, beside other programs, and
#                   how they grow; SCENE (SCENES/suburb), ROUNDS (5), FLIGHT; rewrites docs/bench.md
#   make clean      remove what was built (not the tool cache)

SHELL := bash
.SHELLFLAGS := -eu -o pipefail -c
.DELETE_ON_ERROR:
.PHONY: demo test build lint identical golden score jury judge calibrate bench interrupt fuzz native native-tests setup clean

# Small programs of our own on the crates of wasm-bindgen and wasm-pack, kept for all clones that have the same ones.
CACHE := $(or $(RIDGELINE_CACHE),$(HOME)/.cache/ridgeline)
TOOLS := $(CACHE)/tools/$(shell find www/tools -type f | sort | xargs cat | cksum | tr ' ' '-')
WASM_BINDGEN := $(TOOLS)/wasm-bindgen
WASM_PACK := $(TOOLS)/wasm-pack
# Beside each other: that is where wasm-pack looks for the test runner.
export PATH := $(TOOLS):$(PATH)

STAMPS := target/stamps
WASM32 := $(STAMPS)/wasm32-$(shell rustc --version | cut -d ' ' -f 2)
NPM := www/node_modules/.installed-$(shell cksum < www/package-lock.json | tr ' ' '-')
RUST_SOURCES := $(shell find src -name '*.rs') Cargo.toml Cargo.lock .cargo/config.toml
WWW_SOURCES := $(shell find www -type f -not -name '*.tsbuildinfo' -not -path 'www/node_modules/*' \
	-not -path 'www/dist/*' -not -path 'www/src/pkg*' -not -path 'www/public/entrance/*' -not -path 'www/test*' -not -path 'www/tools/*' -not -path 'www/screenshots/*' \
	-not -path 'www/playwright-report/*')
PACKAGE := www/src/pkg/ridgeline_bg.wasm
# The page's second module: the same crate without the rooms above src/orienting/structure_from_motion.
ORIENTATION := www/src/pkg-orient/orientation_bg.wasm
ENTRANCE := www/public/entrance/model.glb
SITE := www/dist/index.html
PORT ?= 4173
PYTHON ?= python3

demo: $(SITE)
	cd www && npm run --silent preview -- --port $(PORT)

build: $(SITE)
	@echo "The site is in www/dist."

# Two at a time, because compilers end on one core.
test:
	$(MAKE) -j 2 setup $(WASM_PACK) $(STAMPS)/chromium native-tests
	tests/all.sh

# As tests/all.sh compiles them.
native-tests:
	[ -d target/debug/incremental ] || export CARGO_INCREMENTAL=0; cargo test --no-run --quiet

lint: $(WASM32) $(NPM) $(PACKAGE) $(ORIENTATION)
	tests/all.sh lint

identical: native $(PACKAGE) $(ORIENTATION)
	cargo build --release --example synthetic
	node tests/wasm/identical.mjs target/release/ridgeline

golden:
	RIDGELINE_REWRITE=1 cargo test --test pipeline golden
	RIDGELINE_REWRITE=1 cargo test --lib page_table

score: native
	$(PYTHON) tests/evaluation/score_table.py --self-test
	$(PYTHON) tests/evaluation/score_table.py --binary target/release/ridgeline --scenes "$${SCENES:-../shared/scenes}"

jury: native
	$(PYTHON) tests/evaluation/perturb.py --binary target/release/ridgeline --scenes "$${SCENES:-../shared/scenes}"

judge: native
	$(PYTHON) tests/evaluation/compare_on_seeds.py --binary target/release/ridgeline $(if $(BEFORE),--before $(BEFORE)) --seeds $(SEEDS) $(if $(PAGE),--page)

calibrate: native
	$(PYTHON) tests/evaluation/calibrate.py --self-test
	$(PYTHON) tests/evaluation/calibrate.py --binary target/release/ridgeline --fit "$${FIT:-../shared/fit}" \
		--more "$${SCENES:-../shared/scenes}"

bench: native $(PACKAGE)
	$(PYTHON) tests/evaluation/bench.py --self-test
	$(PYTHON) tests/evaluation/bench.py --binary target/release/ridgeline $(if $(BEFORE),--before $(BEFORE)) \
		$(if $(SCENE),--scene $(SCENE)) --rounds $(or $(ROUNDS),5) --scenes "$${SCENES:-../shared/scenes}" \
		--flight "$${FLIGHT:-../shared/flights/sheffield}"

interrupt: native
	cargo build --release --example synthetic
	$(PYTHON) tests/evaluation/interrupted_block.py --binary target/release/ridgeline --times $(or $(TIMES),20) --seed $(or $(SEED),1)

fuzz:
	RIDGELINE_FUZZ_SECONDS=$${FUZZ_SECONDS:-600} cargo test --release --test fuzz -- --nocapture --test-threads 1

native:
	cargo build --release

# All that the tests need besides a browser; the site is built because Chromium opens it.
setup: $(SITE)

clean:
	rm -rf target www/dist www/src/pkg www/src/pkg-orient www/public/entrance www/node_modules

# ---- the wasm package and the site -------------------------------------------------------------

# `build` takes its time for a smaller and faster wasm; all else wants it soon.
PROFILE := $(if $(filter build,$(MAKECMDGOALS)),site,page)
CHOSEN := $(STAMPS)/profile-$(PROFILE)

# When another profile is wanted than the last time, the package is made anew.
$(CHOSEN):
	mkdir -p $(STAMPS)
	rm -f $(STAMPS)/profile-*
	touch $@

WASM = cargo build --lib --profile $(PROFILE) --target wasm32-unknown-unknown
BOUND = wasm-bindgen target/wasm32-unknown-unknown/$(PROFILE)/ridgeline.wasm $(@D)

# In few pieces the unused half of the crate is left out more thoroughly: a visitor waits for this module.
SMALL := --config 'profile.page.package.ridgeline.codegen-units=2'
$(ORIENTATION): $(RUST_SOURCES) $(WASM32) $(WASM_BINDGEN) $(NPM) $(CHOSEN)
	@echo "== The module that orients photographs: three minutes on two cores"
	$(WASM) --no-default-features $(SMALL)
	$(BOUND) orientation

# Cargo puts both in the same place: the later one stays, and the tests in wasm are of that.
$(PACKAGE): $(ORIENTATION)
	@echo "== The module that reconstructs: two minutes on two cores"
	$(WASM)
	$(BOUND) ridgeline

# What the page shows before anything is computed in the browser: the demo scene's model, made by the page's own core.
$(ENTRANCE): $(PACKAGE) www/scripts/entrance.mjs tests/wasm/session.mjs $(shell find www/public/demo -type f)
	@echo "== The demo scene's model and the site: a few seconds"
	node www/scripts/entrance.mjs

$(SITE): $(PACKAGE) $(ORIENTATION) $(ENTRANCE) $(NPM) $(WWW_SOURCES)
	cd www && npm run build
	touch $@

# ---- set-up --------------------------------------------------------------------------------------

$(WASM32):
	mkdir -p $(STAMPS)
	rustup target add wasm32-unknown-unknown
	touch $@

# wasm and program must speak of the same wasm-bindgen.
VERSION_OF = $(shell sed -nE 's/^$(1) = .*"=([0-9.]+)".*/\1/p' $(2))
SAME_VERSION = test "$(call VERSION_OF,wasm-bindgen,Cargo.toml)" = "$(call VERSION_OF,wasm-bindgen-cli-support,www/tools/Cargo.toml)" \
	|| { echo "wasm-bindgen is of another version in Cargo.toml than in www/tools/Cargo.toml" >&2; exit 1; }

# From source: the download pages of ready-made programs are not reachable everywhere. RUSTFLAGS= makes them fit any processor.
BUILD_TOOL = RUSTFLAGS= cargo build --locked --manifest-path www/tools/Cargo.toml --target-dir target/tools

$(WASM_BINDGEN):
	@$(SAME_VERSION)
	@echo "== The program that binds wasm to the page: compiled once, half a minute on two cores"
	$(BUILD_TOOL) --package bindgen
	mkdir -p $(TOOLS)
	cp target/tools/debug/bindgen $@

$(WASM_PACK): $(WASM_BINDGEN)
	$(BUILD_TOOL) --package wasm-tests
	cp target/tools/debug/wasm-bindgen-test-runner $(TOOLS)
	cp target/tools/debug/wasm-pack $@

# The lock file's content decides, not its time: a fresh checkout of the same lock installs nothing.
$(NPM):
	@echo "== The page's packages: a few seconds"
	cd www && npm ci --no-audit --no-fund
	touch $@

# Debian as root: the system's own package. Elsewhere: Playwright's browser. CHROMIUM names another one.
$(STAMPS)/chromium: $(NPM)
	www/scripts/install_chromium.sh
	touch $@

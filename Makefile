# ridgeline: `make demo` and `make test` need rustup's cargo, Node >= 20 and make; the rest is installed
# here, once. Stamps (target/stamps/, www/node_modules/) and the tool cache keep second runs quick.
#
#   make demo       build, serve the page and print its address
#   make test       set up, lint and run every test (native, wasm in Node, TypeScript, Chromium)
#   make build      the static site in www/dist, for any static host
#   make lint       format, clippy (native and wasm32), Biome, TypeScript
#   make identical  the demo and the synthetic scenes natively and in wasm, compared byte for byte
#   make golden     rewrite what the tests expect to be found in the synthetic scenes (tests/golden)
#   make score      all scenes against their truth; rewrites the tables of docs/results.md
#   make fuzz       all readers on damaged files, FUZZ_SECONDS (600) for each format
#   make jury       all scenes many times over, changed a little each time; rewrites its tables there
#   make bench      time of every stage on the synthetic scene, and of the lines of the scene in SCENE
#   make clean      remove what was built (not the tool cache)

SHELL := bash
.SHELLFLAGS := -eu -o pipefail -c
.DELETE_ON_ERROR:
.PHONY: demo test build lint identical golden score jury bench fuzz native setup clean

# The command-line tool must be of exactly the crate's version: stated once, in Cargo.toml.
WASM_BINDGEN_VERSION := $(shell sed -n 's/^wasm-bindgen = "=\(.*\)"/\1/p' Cargo.toml)
WASM_PACK_VERSION := 0.15.1

TOOLS := $(or $(RIDGELINE_CACHE),$(HOME)/.cache/ridgeline)/tools
WASM_BINDGEN := $(TOOLS)/wasm-bindgen-$(WASM_BINDGEN_VERSION)/bin/wasm-bindgen
WASM_PACK := $(TOOLS)/wasm-pack-$(WASM_PACK_VERSION)/bin/wasm-pack
export PATH := $(dir $(WASM_BINDGEN)):$(dir $(WASM_PACK)):$(PATH)

STAMPS := target/stamps
WASM32 := $(STAMPS)/wasm32-$(shell rustc --version | cut -d ' ' -f 2)
NPM := www/node_modules/.installed-$(shell cksum < www/package-lock.json | tr ' ' '-')
RUST_SOURCES := $(shell find src -name '*.rs') Cargo.toml Cargo.lock .cargo/config.toml
WWW_SOURCES := $(shell find www -type f -not -name '*.tsbuildinfo' -not -path 'www/node_modules/*' \
	-not -path 'www/dist/*' -not -path 'www/src/pkg/*' -not -path 'www/test*' -not -path 'www/screenshots/*' \
	-not -path 'www/playwright-report/*')
PACKAGE := www/src/pkg/ridgeline_bg.wasm
SITE := www/dist/index.html
PORT ?= 4173

demo: $(SITE)
	cd www && npm run preview -- --port $(PORT)

build: $(SITE)
	@echo "The site is in www/dist."

test: setup $(WASM_PACK) $(STAMPS)/chromium
	tests/all.sh

lint: $(WASM32) $(NPM) $(PACKAGE)
	tests/all.sh lint

identical: native $(PACKAGE)
	cargo build --release --example synthetic
	node tests/identical.mjs target/release/ridgeline

golden:
	RIDGELINE_REWRITE=1 cargo test --release --test pipeline golden

score: native
	python3 tests/score_table.py --binary target/release/ridgeline --scenes "$${SCENES:-../shared/scenes}"

jury: native
	python3 tests/jury.py --binary target/release/ridgeline --scenes "$${SCENES:-../shared/scenes}"

bench:
	cargo bench --bench stages

fuzz:
	RIDGELINE_FUZZ_SECONDS=$${FUZZ_SECONDS:-600} cargo test --release --test fuzz -- --nocapture --test-threads 1

native:
	cargo build --release

# All that the tests need besides a browser; the site is built because Chromium opens it.
setup: $(SITE)

clean:
	rm -rf target www/dist www/src/pkg www/node_modules

# ---- the wasm package and the site -------------------------------------------------------------

# What makes the linked whole smaller and no slower: few of its loops gain by being unrolled, straight code by vectors that
# are not written as such, or large functions by being inlined because they are generic.
SMALL := -C no-vectorize-slp $(addprefix -C llvm-args=-,unroll-runtime=false unroll-threshold-default=100 \
	unroll-threshold-aggressive=100 inlinehint-threshold=50)

$(PACKAGE): $(RUST_SOURCES) $(WASM32) $(WASM_BINDGEN) $(NPM)
	cargo rustc --lib --profile wasm --target wasm32-unknown-unknown -- $(SMALL)
	wasm-bindgen target/wasm32-unknown-unknown/wasm/ridgeline.wasm --target web --out-dir $(@D) --out-name ridgeline
	node www/scripts/strip.mjs $@

$(SITE): $(PACKAGE) $(NPM) $(WWW_SOURCES)
	cd www && npm run build
	touch $@

# ---- set-up --------------------------------------------------------------------------------------

$(WASM32):
	mkdir -p $(STAMPS)
	rustup target add wasm32-unknown-unknown
	touch $@

# Built from source, for any processor: the download pages of ready-made binaries are not reachable everywhere. The
# locked versions may have been withdrawn since; then any that fit will do.
$(WASM_BINDGEN):
	RUSTFLAGS= cargo install --locked --root $(TOOLS)/wasm-bindgen-$(WASM_BINDGEN_VERSION) wasm-bindgen-cli --version $(WASM_BINDGEN_VERSION) \
		|| RUSTFLAGS= cargo install --root $(TOOLS)/wasm-bindgen-$(WASM_BINDGEN_VERSION) wasm-bindgen-cli --version $(WASM_BINDGEN_VERSION)

$(WASM_PACK):
	RUSTFLAGS= cargo install --locked --root $(TOOLS)/wasm-pack-$(WASM_PACK_VERSION) wasm-pack --version $(WASM_PACK_VERSION) \
		|| RUSTFLAGS= cargo install --root $(TOOLS)/wasm-pack-$(WASM_PACK_VERSION) wasm-pack --version $(WASM_PACK_VERSION)

# The lock file's content decides, not its time: a fresh checkout of the same lock installs nothing.
$(NPM):
	cd www && npm ci --no-audit --no-fund
	touch $@

# Debian as root: the system's own package. Elsewhere: Playwright's browser. CHROMIUM names another one.
$(STAMPS)/chromium: $(NPM)
	tests/install_chromium.sh
	touch $@

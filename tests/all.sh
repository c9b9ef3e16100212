#!/usr/bin/env bash
# Runs every check, goes on after a failure, and ends with the true totals.
#   tests/all.sh         all: what `make test` runs once everything is set up
#   tests/all.sh lint    the checks that run no test
# The output of each step also stands in target/test-logs/. A lint or build step counts as one check.
set -uo pipefail
cd "$(dirname "$0")/.."
logs=target/test-logs
mkdir -p "$logs"
passed=0 failed=0 broken=() times=()
# What would make a second build quicker makes the first one a fifth slower.
[ -d target/debug/incremental ] || export CARGO_INCREMENTAL=0

# The sum of the numbers that a pattern (with \1) finds in a log.
sum() { sed -E $'s/\e\\[[0-9;]*m//g' "$2" | sed -nE "s/$1/\1/p" | awk '{ s += $1 } END { print s + 0 }'; }

# step NAME KIND COMMAND...: KIND is cargo, node or playwright (whose totals are read), or check.
step() {
    local name=$1 kind=$2 log="$logs/$1.log" good=0 bad=0 status=0
    shift 2
    printf '\n== %s: %s\n' "$name" "$*"
    local start=$SECONDS
    "$@" 2>&1 | tee "$log" || status=1
    times+=("$name $((SECONDS - start)) s")
    case $kind in
        cargo)
            good=$(sum '^test result: [^0-9]*([0-9]+) passed.*' "$log")
            bad=$(sum '^test result: .* ([0-9]+) failed.*' "$log") ;;
        node) # node:test and vitest
            good=$(($(sum '^[^ ]+ pass ([0-9]+).*' "$log") + $(sum '^ *Tests .*[^0-9]([0-9]+) passed.*' "$log")))
            bad=$(($(sum '^[^ ]+ fail ([0-9]+).*' "$log") + $(sum '^ *Tests .*[^0-9]([0-9]+) failed.*' "$log"))) ;;
        playwright)
            good=$(sum '^ +([0-9]+) passed.*' "$log")
            bad=$(sum '^ +([0-9]+) failed.*' "$log") ;;
        check) good=$((1 - status)) ;;
    esac
    # A step that fails without a failing test (it did not compile, say), or that ran no test at all,
    # is a failure too.
    if ((status != 0 && bad == 0)) || ((good + bad == 0)); then bad=1; fi
    ((bad == 0)) || broken+=("$name")
    passed=$((passed + good)) failed=$((failed + bad))
}

# start NAME COMMAND...: runs it beside the steps that follow; `step NAME KIND finished NAME` takes its result.
start() {
    local name=$1 out="$logs/$1.out"
    shift
    rm -f "$out.status"
    { "$@" > "$out" 2>&1; echo $? > "$out.status"; } &
}

finished() {
    local out="$logs/$1.out"
    until [ -s "$out.status" ]; do sleep 1; done
    cat "$out"
    return "$(< "$out.status")"
}

www() { (cd www && npm run --silent "$@"); }

formatted() { cargo fmt --all --check && cargo fmt --all --check --manifest-path www/tools/Cargo.toml; }

# With the page's profile, which has its derives compiled already; both modules of the page and the tests in wasm, whose lines
# the native run does not see.
clippy_wasm32() {
    local status=0
    for part in --lib "--lib --no-default-features" "--tests --package ridgeline-wasm"; do
        cargo clippy $part --quiet --profile page --target wasm32-unknown-unknown -- -D warnings || status=1
    done
    return $status
}

# Names dependencies that nothing uses: crates by their paths, packages by where they are imported or configured.
all_dependencies_are_used() {
    local name unused=0
    for name in $(awk '/^\[/ { on = /dependencies\]$/; next } on && / = / { print $1 }' Cargo.toml); do
        # Named for its feature alone.
        [ "$name" = getrandom ] && continue
        grep -rqE "\b${name//-/_}(::|!)" --include='*.rs' src tests benches examples && continue
        echo "Cargo.toml: nothing uses $name"
        unused=1
    done
    local packages='const p = require("./www/package.json"); console.log(Object.keys({ ...p.dependencies, ...p.devDependencies }).join(" "))'
    for name in $(node -e "$packages"); do
        # The compiler is called, the types belong to what they describe.
        [ "$name" = typescript ] && continue
        grep -rqE "[\"'/]${name#@types/}[\"'/:]" --include='*.ts' --include='*.tsx' --include='*.mjs' --include=biome.json \
            --exclude-dir={node_modules,pkg,pkg-orient,dist} www tests && continue
        echo "www/package.json: nothing uses $name"
        unused=1
    done
    return $unused
}

step dependencies check all_dependencies_are_used
step format check formatted
step economy check "${PYTHON:-python3}" tests/evaluation/economy.py
start clippy-wasm32 clippy_wasm32
step clippy-native check cargo clippy --all-targets --quiet -- -D warnings
step typecheck check www typecheck
step biome check www lint
step clippy-wasm32 check finished clippy-wasm32
if [ "${1:-all}" = all ]; then
    # While tests that end late leave a core free.
    start size www size
    start wasm wasm-pack test --node --mode no-install tests/wasm --profile page
    step native cargo cargo test --quiet --no-fail-fast
    # What computes natively and in wasm side by side, and leaves gaps for what needs one core.
    start identical node tests/wasm/identical.mjs target/debug/ridgeline
    step doc check env RUSTDOCFLAGS="-D warnings" cargo doc --no-deps --quiet
    step wasm cargo finished wasm
    step typescript node www test:unit
    step size check finished size
    step identical check finished identical
    # Named, so that the comparison with it is not skipped.
    export RIDGELINE=$PWD/target/debug/ridgeline
    step interrupt check "${PYTHON:-python3}" tests/evaluation/interrupted_block.py --binary target/debug/ridgeline
    step page playwright www test:e2e
fi

printf '\nTimes:'
printf ' %s;' "${times[@]}"
printf '\n'
((failed == 0)) || printf 'Failed in: %s (logs in %s)\n' "${broken[*]}" "$logs"
printf '%d passed, %d failed\n' "$passed" "$failed"
((failed == 0))

#!/usr/bin/env bash
# Every reader under libFuzzer for SECONDS_EACH (600) seconds, or those that are named:
#   tests/coverage_fuzz/run.sh [SAMPLE...]
# A sample is a folder of tests/fixtures. Finds and the inputs that reach new code are kept in target/coverage-fuzz.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "$0")/../.."
out=$PWD/target/coverage-fuzz
# The instrumentation of libFuzzer, by options of the stable compiler.
export RUSTFLAGS="--cfg fuzzing -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
-Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
-Cllvm-args=-sanitizer-coverage-trace-compares -Ccodegen-units=1"
cargo build --release --manifest-path tests/coverage_fuzz/Cargo.toml --target-dir "$out/target" \
    --target "$(rustc -vV | sed -n 's/^host: //p')"
program=$(echo "$out"/target/*/release/coverage-fuzz)

samples=("$@")
if ((${#samples[@]} == 0)); then
    for folder in tests/fixtures/*/; do
        folder=$(basename "$folder")
        case $folder in finds | cases) ;; *) samples+=("$folder") ;; esac
    done
fi
failed=0
for sample in "${samples[@]}"; do
    corpus=$out/$sample
    mkdir -p "$corpus/new" "$corpus/finds"
    export RIDGELINE_FUZZ_FOLDER=$PWD/tests/fixtures/$sample
    unset RIDGELINE_FUZZ_IMAGES
    case $sample in
        images | tiff)
            export RIDGELINE_FUZZ_IMAGES=1
            cp tests/fixtures/"$sample"/*.* "$corpus/new" ;;
        *) # The sample as one input, as the program takes it apart.
            for file in tests/fixtures/"$sample"/*; do
                cat "$file"
                printf '\x1e\x1e'
            done > "$corpus/new/sample" ;;
    esac
    log=$corpus/log
    "$program" -max_total_time="${SECONDS_EACH:-600}" -timeout=60 -rss_limit_mb=4096 -max_len=200000 \
        -artifact_prefix="$corpus/finds/" "$corpus/new" > "$log" 2>&1 || failed=1
    runs=$(sed -nE 's/^Done ([0-9]+) runs.*/\1/p' "$log")
    cover=$(sed -nE 's/.*cov: ([0-9]+) .*/\1/p' "$log" | tail -1)
    printf '%s: %s inputs, %s edges reached, %s finds\n' "$sample" "${runs:-stopped}" "${cover:-0}" \
        "$(find "$corpus/finds" -type f | wc -l)"
done
exit $failed

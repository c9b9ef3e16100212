#!/usr/bin/env bash
# Every reader under libFuzzer for SECONDS_EACH (600) seconds, or those that are named:
#   tests/coverage_fuzz/run.sh [SAMPLE...]
# A sample is a folder of tests/fixtures, or `archive` or `project`. Finds and the inputs that reach
# new code are kept in target/coverage-fuzz; a later run goes on from there. PROGRAM is one that was
# built before.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "$0")/../.."
out=$PWD/target/coverage-fuzz
mkdir -p "$out"
if [[ -z ${PROGRAM:-} ]]; then
    # The library with the packages that it is tested with.
    cp Cargo.lock tests/coverage_fuzz/Cargo.lock
    # The instrumentation of libFuzzer, by options of the stable compiler.
    export RUSTFLAGS="--cfg fuzzing -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
-Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
-Cllvm-args=-sanitizer-coverage-trace-compares -Ccodegen-units=1"
    cargo build --release --manifest-path tests/coverage_fuzz/Cargo.toml --target-dir "$out/target" \
        --target "$(rustc -vV | sed -n 's/^host: //p')"
    PROGRAM=$(echo "$out"/target/*/release/coverage-fuzz)
fi

# The words that the readers know: comparisons of strings do not tell libFuzzer what they expect.
grep -ohrE '"[A-Za-z_$<][A-Za-z0-9_]{1,30}"' src/orienting/orientation src/base/params src/orienting/scene_loader |
    sort -u > "$out/words"

samples=("$@")
if ((${#samples[@]} == 0)); then
    for folder in tests/fixtures/*/; do
        folder=$(basename "$folder")
        case $folder in finds | cases) ;; *) samples+=("$folder") ;; esac
    done
    samples+=(archive project)
fi
failed=0
echo "| sample | inputs | edges at first | edges at last | slowest | memory | finds |"
for sample in "${samples[@]}"; do
    corpus=$out/$sample
    mkdir -p "$corpus/new" "$corpus/finds"
    export RIDGELINE_FUZZ_FOLDER=$PWD/tests/fixtures/$sample
    unset RIDGELINE_FUZZ_ONE
    case $sample in
        images | tiff)
            export RIDGELINE_FUZZ_ONE=image
            cp tests/fixtures/"$sample"/*.* "$corpus/new" ;;
        known)
            export RIDGELINE_FUZZ_ONE=known
            cp tests/fixtures/known/* "$corpus/new" ;;
        archive)
            export RIDGELINE_FUZZ_ONE=archive
            python3 -m zipfile -c "$corpus/new/sample" tests/fixtures/{colmap,nerfstudio}/* ;;
        project)
            export RIDGELINE_FUZZ_ONE=project
            echo '{"ridgeline": "0.1.0", "options": {"views": ["a"]}, "params": {}}' \
                > "$corpus/new/sample" ;;
        *) # The sample as one input, as the program takes it apart.
            for file in tests/fixtures/"$sample"/*; do
                cat "$file"
                printf '\x1e\x1e'
            done > "$corpus/new/sample" ;;
    esac
    log=$corpus/log
    "$PROGRAM" -max_total_time="${SECONDS_EACH:-600}" -timeout=60 -rss_limit_mb=4096 \
        -max_len=200000 -print_final_stats=1 -dict="$out/words" \
        -artifact_prefix="$corpus/finds/" "$corpus/new" > "$log" 2>&1 || failed=1
    of() { sed -nE "s/$1/\1/p" "$log" | tail -1; }
    printf '| %s | %s | %s | %s | %s s | %s MB | %s |\n' "$sample" \
        "$(of '^stat::number_of_executed_units: *([0-9]+)')" "$(of '.*INITED cov: ([0-9]+) .*')" \
        "$(of '.*cov: ([0-9]+) .*')" "$(of '^stat::slowest_unit_time_sec: *([0-9]+)')" \
        "$(of '^stat::peak_rss_mb: *([0-9]+)')" "$(find "$corpus/finds" -type f | wc -l)"
done
exit $failed

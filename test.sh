#!/usr/bin/env bash
# Builds Trackbed and runs its tests.
#   ./test.sh [--long] [PRESET]    PRESET: release (default), debug, asan-ubsan, tsan
#   --long    also the tests that take minutes (labels "long" and "slurm")
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
preset=release
selection=(--label-exclude '^(long|slurm)$')
for argument in "$@"; do
  case $argument in
    --long) selection=() ;;
    release | debug | asan-ubsan | tsan) preset=$argument ;;
    *)
      sed -n '2,/^set/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2
      [[ $argument == -h || $argument == --help ]] && exit 0
      echo "test.sh: \"$argument\" is not known" >&2
      exit 2
      ;;
  esac
done

"$root/scripts/setup.sh" "$preset"

# Several test programs share the cores: a thread that waits must not burn one.
export OMP_WAIT_POLICY=${OMP_WAIT_POLICY:-passive}
# clang's OpenMP runtime is not instrumented; it reports its barriers itself.
export TSAN_OPTIONS=${TSAN_OPTIONS:-ignore_noninstrumented_modules=1}

start=$SECONDS
status=0
ctest --test-dir "$root/build/$preset" --output-on-failure --no-tests=error --parallel "$(nproc)" \
  "${selection[@]}" || status=$?
printf '== tests: %d s\n' $((SECONDS - start))
exit $status

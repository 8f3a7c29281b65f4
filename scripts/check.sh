#!/usr/bin/env bash
# Everything that should hold before a commit: the format of the sources, the release build and its tests.
#   scripts/check.sh [--all]       --all: the tests once more under the address, undefined and thread sanitizers
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
presets=(release)
case "${1:-}" in
  "") ;;
  --all) presets+=(asan-ubsan tsan) ;;
  *)
    echo "usage: scripts/check.sh [--all]" >&2
    exit 2
    ;;
esac

if ! command -v clang-format-14 >/dev/null; then
  echo "The format check needs clang-format-14: apt-get install clang-format-14" >&2
  exit 1
fi
cd "$root"
find src app tests bench -name '*.h' -print0 -o -name '*.cpp' -print0 |
  xargs -0 --no-run-if-empty clang-format-14 --dry-run -Werror ||
  { echo "To put the format right: clang-format-14 -i FILE..." >&2; exit 1; }
echo "== format: all sources as .clang-format has them"

for preset in "${presets[@]}"; do
  ./test.sh "$preset"
done

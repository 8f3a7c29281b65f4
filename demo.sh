#!/usr/bin/env bash
# Builds Trackbed and runs the cyclic box test into out/cyclic-box: ballast in a box under a sleeper that is
# loaded over and over. Arguments go to "trackbed run", for example ./demo.sh --threads 4
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
"$root/scripts/setup.sh" release

start=$SECONDS
"$root/build/release/trackbed" run "$root/cases/cyclic-box/case.toml" --out "$root/out/cyclic-box" "$@"
printf '== run: %d s\n' $((SECONDS - start))
echo "The results are in $root/out/cyclic-box; README.md says what each file there is."

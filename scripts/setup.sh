#!/usr/bin/env bash
# Takes a Debian 12 machine to a built program: installs the packages that are missing, configures, builds.
#   scripts/setup.sh [PRESET]      PRESET: release (default), debug, asan-ubsan, tsan
# Asks no network when every package is there. CMAKE_BUILD_PARALLEL_LEVEL overrides the number of jobs.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
preset=${1:-release}
build=$root/build/$preset

say() { printf '%s\n' "$*" >&2; }

# One line per part with its wall-clock seconds; scripts/trials/fresh-machine.sh collects these.
finished() { printf '== %s: %d s\n' "$1" $((SECONDS - part_start)); part_start=$SECONDS; }
part_start=$SECONDS

wanted_packages() {
  local list
  for list in "$root/scripts/packages.txt" "$root/scripts/packages-$preset.txt"; do
    [[ ! -e $list ]] || sed 's/#.*//' "$list" | xargs -n1
  done
}

missing_packages() {
  local present
  present=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' | sed -n 's/^installed //p' | sort -u)
  comm -23 <(wanted_packages | sort -u) <(printf '%s\n' "$present")
}

install_packages() {
  local as_root=()
  local command="apt-get update && apt-get install --no-install-recommends $*"
  if ! command -v apt-get >/dev/null; then
    say "Trackbed needs these Debian packages, and this machine has no apt-get to install them: $*"
    exit 1
  fi
  if [[ $(id -u) != 0 ]]; then
    if ! sudo -n true 2>/dev/null; then
      say "Trackbed needs packages that are not installed: $*"
      say "Install them as root, then run this again:"
      say "  sudo sh -c '$command'"
      exit 1
    fi
    as_root=(sudo -n)
  fi
  say "Installing: $*"
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300)
  if ! { "${apt[@]}" update && "${apt[@]}" install -y --no-install-recommends "$@"; } </dev/null; then
    say "Could not install: $*"
    say "Is there a network, and a Debian 12 source in /etc/apt? The command was: $command"
    exit 1
  fi
}

# The largest files (those with CGAL) take about 1.5 GB each to compile.
jobs() {
  local cores free_kib by_memory
  cores=$(nproc)
  free_kib=$(awk '/^MemAvailable/ {print $2}' /proc/meminfo)
  by_memory=$((free_kib / (2 * 1024 * 1024)))
  echo $((by_memory < 1 ? 1 : by_memory < cores ? by_memory : cores))
}

if [[ " release debug asan-ubsan tsan " != *" $preset "* ]]; then
  say "Unknown preset \"$preset\": there are release, debug, asan-ubsan and tsan."
  exit 2
fi

if command -v dpkg-query >/dev/null; then
  mapfile -t missing < <(missing_packages)
  if ((${#missing[@]})); then
    install_packages "${missing[@]}"
    finished packages
  fi
else
  say "This is not a Debian system, so its packages cannot be checked; Trackbed needs what these are in Debian 12:"
  say "  $(wanted_packages | xargs)"
fi

# ccache keeps its files in the home folder; where that cannot be written, they go beside the build.
if [[ -z ${CCACHE_DIR:-} ]]; then
  cache=${XDG_CACHE_HOME:-${HOME:-/nonexistent}/.cache}/ccache
  { mkdir -p "$cache" && [[ -w $cache ]]; } 2>/dev/null || export CCACHE_DIR=$root/build/ccache
fi

# A build folder that was copied here with the sources knows the old place only: configure it anew.
fresh=()
if [[ -e $build/CMakeCache.txt ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$build/CMakeCache.txt"; then
  fresh=(--fresh)
fi

cd "$root"
cmake --preset "$preset" "${fresh[@]}" -Wno-dev --log-level=WARNING
finished configure
cmake --build "$build" --parallel "${CMAKE_BUILD_PARALLEL_LEVEL:-$(jobs)}"
finished build

#!/usr/bin/env bash
# Takes the node of with-slurm.sh down with all that runs on it, as a loss of power would, or brings it back.
#   scripts/slurm/node.sh kill|start
set -euo pipefail
PATH=$PATH:/usr/sbin

# The processes below a process, with it.
tree_of() {
  local child
  for child in $(cat "/proc/$1/task/"*/children 2>/dev/null); do tree_of "$child"; done
  echo "$1"
}

case ${1:-} in
  kill)
    # Steps are not children of slurmd: they name the node's folder in their environment.
    victims=()
    [[ ! -s $TRACKBED_SLURM/slurmd.pid ]] || victims+=("$(cat "$TRACKBED_SLURM/slurmd.pid")")
    for process in $(pgrep -x slurmstepd || true); do
      grep -qz "^SLURM_CONF=$SLURM_CONF$" "/proc/$process/environ" 2>/dev/null && victims+=($(tree_of "$process"))
    done
    ((${#victims[@]} == 0)) || kill -9 "${victims[@]}" 2>/dev/null || true
    ;;
  start) slurmd ;;
  *)
    sed -n '2,3s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2
    exit 2
    ;;
esac

#!/usr/bin/env bash
# shellcheck disable=SC2317 # functions are called through "try"
#
# Does a bare Debian 12 machine get to a built, tested program with nothing but ./test.sh and ./demo.sh?
# Makes such a machine in a folder (debootstrap, minimal variant), puts the committed files into it and runs
# both there under chroot. Prints what passed and the seconds of each part; exits with 1 if anything failed.
# Needs root, debootstrap and a Debian mirror.
#
#   scripts/trials/fresh-machine.sh [OPTION...] [DIR]
#     DIR             where to make the machine: a new or empty folder (default: one under $TMPDIR)
#     --from CLONE    try the commit checked out in this other clone
#     --work-tree     try the files as they lie, uncommitted ones too, instead of the last commit
#     --only PART     test or demo
#     --minutes N     limit for each of the two (default 60)
#     --keep          leave the machine there afterwards
# The full output goes to out/fresh-machine/{machine,test,demo}.log.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)
logs=$here/out/fresh-machine
suite=bookworm
home="/root/track bed" # with a blank, so that the scripts are tried with one
apart=(unshare --mount --pid --fork --kill-child --propagation private)

fail() {
  echo "fresh-machine.sh: $*" >&2
  exit 2
}

from=$here work_tree=0 parts=(test demo) minutes=60 keep=0 machine=
while (($#)); do
  case $1 in
    --from) from=$(cd "${2:?--from needs a clone}" && pwd -P) && shift 2 ;;
    --work-tree) work_tree=1 && shift ;;
    --only)
      [[ ${2:-} == test || ${2:-} == demo ]] || fail "--only takes test or demo"
      parts=("$2") && shift 2
      ;;
    --minutes) minutes=${2:?--minutes needs a number} && shift 2 ;;
    --keep) keep=1 && shift ;;
    -h | --help) sed -n '4,/^set/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" && exit 0 ;;
    -*) fail "unknown option $1; --help lists them" ;;
    *) machine=$1 && shift ;;
  esac
done

[[ $(id -u) == 0 ]] || fail "making a machine in a folder needs root"
command -v debootstrap >/dev/null || fail "debootstrap is missing: apt-get install debootstrap"
commit=$(git -C "$from" rev-parse HEAD 2>/dev/null) || fail "$from is not a git clone" # others may follow meanwhile
[[ -n $machine ]] || machine=$(mktemp -d "${TMPDIR:-/tmp}/fresh-machine.XXXXXX")
mkdir -p "$machine" "$logs"
machine=$(cd "$machine" && pwd -P)
[[ -z $(ls -A "$machine") ]] || fail "$machine is not empty"
rm -f "$logs"/*.log

# Mounts live in a namespace that ends with its last process (see in_machine); what is left is a plain folder.
job=
clean_up() {
  [[ -z $job ]] || kill -KILL -- "-$job" 2>/dev/null || true
  wait
  if ((keep)); then
    echo "The machine is kept in $machine"
  else
    rm -rf --one-file-system "$machine"
  fi
}
trap clean_up EXIT
trap 'exit 130' INT TERM HUP

table=()
row() { table+=("$(printf '%-9s %-18s %6s s' "$1" "$2" "$3")"); }

# The mirror, proxy and key settings of this machine, as far as they concern Debian 12.
copy_apt_settings() {
  local file
  for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources; do
    if [[ -e $file ]] && grep -v '^ *#' "$file" | grep -qw "$suite"; then
      rm -f "$machine/etc/apt/sources.list"
      cp "$file" "$machine/etc/apt/sources.list.d/"
    fi
  done
  cp -rn /etc/apt/trusted.gpg.d /etc/apt/keyrings "$machine/etc/apt/" 2>/dev/null || true
  apt-config dump | grep -iE '^Acquire::(https?|ftp|Check-Valid-Until|Check-Date|Retries)' \
    >"$machine/etc/apt/apt.conf.d/90host" || true
  cp -L /etc/resolv.conf /etc/hosts "$machine/etc/"
}

make_machine() {
  local mirror
  mirror=$(grep -hoE 'https?://[^ ]+/debian/?( |$)' /etc/apt/sources.list /etc/apt/sources.list.d/*.{list,sources} \
    2>/dev/null | head -n 1 | tr -d ' ')
  "${apart[@]}" debootstrap --variant=minbase "$suite" "$machine" "${mirror:-http://deb.debian.org/debian}" &&
    copy_apt_settings
}

copy_sources() {
  mkdir -p "$machine$home"
  if ((work_tree)); then
    (cd "$from" && git ls-files -z --cached --others --exclude-standard |
      while IFS= read -r -d '' file; do [[ ! -e $file ]] || printf '%s\0' "$file"; done |
      tar --null --files-from=- -cf -)
  else
    git -C "$from" archive "$commit"
  fi | tar -xf - -C "$machine$home"
}

# Runs a command in the machine, in the sources' folder, with nothing of this machine's environment but proxies.
in_machine() {
  local setting settings=(HOME=/root LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin)
  for setting in http_proxy https_proxy no_proxy; do
    [[ -z ${!setting:-} ]] || settings+=("$setting=${!setting}")
  done
  timeout --foreground --signal=KILL "${minutes}m" \
    "${apart[@]}" --root="$machine" --wd="$home" --mount-proc env -i "${settings[@]}" "$@"
}

# try NAME COMMAND...: runs it with its output in NAME.log, and adds a row for it and for each part it tells of.
try() {
  local name=$1 start=$SECONDS status=0 result=passed
  shift
  echo "$name: $* ..."
  set -m # a process group of its own, which clean_up can end
  "$@" >"$logs/$name.log" 2>&1 </dev/null &
  job=$!
  set +m
  wait "$job" || status=$?
  job=
  while read -r part seconds; do row "" "$part" "$seconds"; done \
    < <(sed -n 's/^== \([a-z]*\): \([0-9]*\) s$/\1 \2/p' "$logs/$name.log")
  if ((status)); then
    result="FAILED ($status)"
    ((status == 137)) && result="OUT OF TIME"
    echo "--- the end of $logs/$name.log:"
    tail -n 25 "$logs/$name.log" | cut -c1-200
    echo "---"
  fi
  row "$name" "$result" $((SECONDS - start))
  return $status
}

failed=0
if try machine make_machine; then
  copy_sources
  for part in "${parts[@]}"; do
    try "$part" in_machine "./$part.sh" || failed=1
  done
else
  failed=1
fi

echo
echo "A bare Debian 12 machine, $(nproc) cores; $(git -C "$from" log -1 --format='%h %s' "$commit")$( ((work_tree)) && echo ', as it lies')"
printf '  %s\n' "${table[@]}"
exit $failed

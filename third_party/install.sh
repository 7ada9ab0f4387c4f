#!/usr/bin/env bash
# Installs the packages of packages.txt that are missing. Does nothing, quickly, when none is.
set -euo pipefail

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
fail() {
  echo "third_party/install.sh: $*" >&2
  exit 1
}

# BRUME_SKIP_INSTALL=1: the libraries come from elsewhere, and CMake says if one is missing.
[[ "${BRUME_SKIP_INSTALL:-0}" == 1 ]] && exit 0

mapfile -t wanted < <(sed -E 's/#.*//; s/[[:space:]]+//g; /^$/d' "$here/packages.txt")

command -v dpkg-query > /dev/null && command -v apt-get > /dev/null ||
  fail "not a Debian system: install what third_party/packages.txt names, then set BRUME_SKIP_INSTALL=1."

# "ii" is an installed package; names come out as they went in, whatever the architecture.
states="$(dpkg-query -W -f='${db:Status-Abbrev} ${Package}\n' "${wanted[@]}" 2> /dev/null || true)"
installed="$(sed -n 's/^ii *//p' <<< "$states")"
missing=()
for package in "${wanted[@]}"; do
  [[ $'\n'"$installed"$'\n' == *$'\n'"$package"$'\n'* ]] || missing+=("$package")
done
[[ ${#missing[@]} -eq 0 ]] && exit 0

as_root=(env)
if [[ $EUID -ne 0 ]]; then
  command -v sudo > /dev/null || fail "run me as root, or install sudo, to install: ${missing[*]}"
  as_root=(sudo env)
fi
apt=("${as_root[@]}" DEBIAN_FRONTEND=noninteractive apt-get -q -o Acquire::Retries=3 -o DPkg::Lock::Timeout=120)

# Mirrors hiccup: three tries, then apt's own last words.
log="$(mktemp)"
trap 'rm -f "$log"' EXIT
retry() {
  local try
  for try in 1 2 3; do
    "$@" > "$log" 2>&1 && return 0
    [[ $try -eq 3 ]] || sleep $((try * 3))
  done
  tail -n 20 "$log" >&2
  return 1
}

echo "Installing ${missing[*]}" >&2
# A list that cannot be fetched may be one that nothing here comes from, so it is no reason to stop.
retry "${apt[@]}" -o APT::Update::Error-Mode=any update ||
  echo "third_party/install.sh: not all package lists could be fetched (see above); trying with what there is." >&2
retry "${apt[@]}" install -y --no-install-recommends "${missing[@]}" ||
  fail "apt could not install ${missing[*]} (see above); check the network and the apt sources."

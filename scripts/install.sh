#!/usr/bin/env bash
# Installs Debian or Ubuntu packages that tests use, if that needs no password: as root, or through a sudo that does not ask.
#   scripts/install.sh PACKAGE...
# Otherwise prints the command to type and fails. BABYBENCH_INSTALL=no turns installing off.
set -euo pipefail
refuse() { echo "not installed ($1): apt install ${packages[*]}" >&2; exit 1; }
packages=("$@")
if [ "${BABYBENCH_INSTALL:-}" = no ]; then refuse 'BABYBENCH_INSTALL=no'; fi
if ! command -v apt-get >/dev/null; then refuse 'this system has no apt-get'; fi
as_root=''
if [ "$(id -u)" -ne 0 ]; then
  if ! sudo -n true 2>/dev/null; then refuse 'it needs root'; fi
  as_root='sudo -n'
fi
echo "installing ${packages[*]}"
mkdir -p "$(dirname "$0")/../target"
exec 9>"$(dirname "$0")/../target/install.lock"
flock 9 # parts of the tests that run side by side take turns
apt() { $as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=600 "$@"; }
apt update || echo 'package lists are not refreshed' >&2
apt install -y --no-install-recommends "${packages[@]}" >/dev/null

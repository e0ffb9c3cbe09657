#!/usr/bin/env bash
# Runs the README's two commands in a minimal Debian, as a user without sudo, with nothing installed but what the README names: gcc and Rust,
# and for the second command Python 3 with venv and pip, and Node 20.
#   scripts/plain_machine.sh [SUITE...]         # both commands, in Debian's stable and oldstable; writes docs/plain-machine.md
#   scripts/plain_machine.sh first [SUITE...]   # only the first command, in stable, with little optimisation; writes no table
# Reads the commands from README.md and tests the last commit. Needs Linux, root, rustup, the network, and debootstrap, which apt installs if
# it is missing. The new system uses this machine's proxies, certificates and package indexes. If rustup cannot download Rust there, it uses
# this machine's toolchain. Systems are built in target/plain and removed at the end; logs stay.
set -euo pipefail
cd "$(dirname "$0")/.."
place=$PWD/target/plain
person=/home/person
checkout=$person/babybench

only_first='' settings=''
if [ "${1:-}" = first ]; then
  only_first=yes settings='CARGO_PROFILE_RELEASE_OPT_LEVEL=1 ' # what it needs is the same, and it takes half as long to build
  shift
fi
if [ $# -gt 0 ]; then suites=("$@"); elif [ -n "$only_first" ]; then suites=(stable); else suites=(stable oldstable); fi

say() { echo "=== plain machine: $*"; }
die() { echo "scripts/plain_machine.sh: $*" >&2; exit 2; }

command_of_readme() { # BEGINNING: the first command in a block of the README that begins so, as it stands
  awk -v beginning="$1" '/^```/ { inside = /^```sh/; next } inside && index($0, beginning) == 1 { print; exit }' README.md
}
first=$(command_of_readme 'cargo run ')
second=$(command_of_readme 'scripts/test.sh')
if [ -z "$first" ] || [ -z "$second" ]; then die 'README.md has no block with `cargo run ...` and `scripts/test.sh`'; fi
[ "$(id -u)" -eq 0 ] || die 'must be root: it makes systems to change into'
command -v debootstrap >/dev/null || scripts/install.sh debootstrap
commit=$(git rev-parse --short HEAD)
if [ -n "$(git status --porcelain)" ]; then say "changes that are not committed are left out: this is $commit"; fi

# Runs a command as root inside $root, in its own mount and process namespaces, so that no mount outlives it.
inside() { # COMMAND...
  # shellcheck disable=SC2016 # expanded by the inner shell
  unshare --mount --pid --fork --kill-child sh -euc '
    root=$1 toolchain=$2 place=$3
    shift 3
    mount -t proc proc "$root/proc"
    mount --rbind /sys "$root/sys"
    mount --rbind /dev "$root/dev"
    if [ -n "$toolchain" ]; then
      mkdir -p "$root$place"
      mount --bind "$toolchain" "$root$place"
      mount -o remount,bind,ro "$root$place"
    fi
    exec chroot "$root" "$@"' sh "$root" "$toolchain" "$person/.rustup/toolchains/${toolchain_name:-}" "$@"
}
typed() { # COMMAND LINE: runs it in a login shell of the user, in the checkout
  inside su --login person -c "cd $checkout && $settings$1"
}
packages() { # PACKAGE...
  inside env DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends "$@" >>"$log" 2>&1
}

# Copies this machine's settings for registries: proxies, certificates and indexes, nothing else.
copy_network_settings() {
  local file name
  for file in /etc/resolv.conf /etc/hosts /etc/pip.conf /etc/npmrc; do
    if [ -f "$file" ]; then cp -L "$file" "$root$file"; fi
  done
  apt-config dump Acquire | grep -Ei 'proxy|check-|verify|cainfo' >"$root/etc/apt/apt.conf.d/90network" || true # no such setting
  for file in .config/pip/pip.conf .pip/pip.conf .npmrc .cargo/config.toml; do
    if [ -f "$HOME/$file" ]; then install -D -m 644 "$HOME/$file" "$root$person/$file"; fi
  done
  for name in $(compgen -e); do
    case $name in
      PIP_FIND_LINKS) ;; # a folder of this machine
      *_proxy | *_PROXY | PIP_* | npm_config_* | CARGO_HTTP_* | CARGO_REGISTRY* | CARGO_REGISTRIES* | SSL_CERT_* | *_CA_BUNDLE | NODE_EXTRA_CA_CERTS)
        printf 'export %s=%q\n' "$name" "${!name}" >>"$root$person/.profile" ;;
    esac
  done
  if [ -f /etc/ssl/certs/ca-certificates.crt ]; then cp -L /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/"; fi
}

# Installs rustup, which downloads the toolchain that rust-toolchain.toml names.
install_rust() {
  local rustup
  rustup=$(command -v rustup) || die 'this machine has no rustup to install Rust with'
  command install -m 755 "$(realpath "$rustup")" "$root/tmp/rustup-init"
  inside su --login person -c '/tmp/rustup-init -y --quiet --profile minimal --default-toolchain none' >>"$log" 2>&1
  if typed 'rustup toolchain install --no-self-update' >>"$log" 2>&1; then
    rust_from='rustup'
  else
    toolchain_name=$(rustup show active-toolchain | cut -d' ' -f1)
    toolchain=$(rustc --print sysroot)
    rust_from='the host, because rustup could not download it'
  fi
  rust=$(typed 'rustc --version')
}

# Installs Debian's Node, or Node 20 from npm if Debian's is older.
install_node() {
  packages nodejs npm
  if ! inside node -e 'process.exit(parseInt(process.versions.node) < 20 ? 1 : 0)'; then
    inside npm install --global --silent node@20 >>"$log" 2>&1
  fi
}

row() { rows+=("| $1 | $2 |"); }
duration() { printf '%d min %02d s' $(($1 / 60)) $(($1 % 60)); }
since() { duration $((SECONDS - $1)); } # SECONDS

# Runs a command of the README and records the result.
run_command() { # NAME COMMAND
  local started=$SECONDS code=0 result=passed
  say "$suite: $2"
  typed "$2" 2>&1 | tee "$place/$suite-$1.log" || code=$?
  if [ "$code" -ne 0 ]; then result="**failed** (exit $code)" failed=yes; fi
  say "$suite: the $1 command: $result, $(since "$started")"
  row "$1 command" "$result, $(since "$started")"
}

try() { # SUITE
  suite=$1 root=$place/$1 log=$place/$1.log toolchain='' toolchain_name='' rows=()
  local started=$SECONDS
  say "$suite: a minimal Debian, gcc and Rust"
  rm -rf --one-file-system "$root"
  mkdir -p "$place"
  debootstrap --variant=minbase --include=ca-certificates "$suite" "$root" >"$log" 2>&1 || { tail -n 20 "$log" >&2; die "debootstrap failed: $log"; }
  inside useradd --create-home --shell /bin/bash person
  copy_network_settings
  inside apt-get update -qq >>"$log" 2>&1
  packages gcc libc6-dev
  mkdir "$root$checkout"
  git archive HEAD | tar -x -C "$root$checkout"
  inside chown -R person: "$person"
  install_rust
  row 'Debian' "$(inside cat /etc/debian_version), $(inside uname -m)"
  row 'gcc' "$(version gcc)"
  row 'Rust' "$rust, from $rust_from"
  row 'the system, gcc and Rust' "installed in $(since "$started")"
  run_command first "$first"
  if [ -z "$only_first" ]; then
    started=$SECONDS
    packages python3 python3-venv python3-pip
    install_node
    row 'Python' "$(version python3), with python3-venv $(version python3-venv) and python3-pip $(version python3-pip)"
    row 'Node' "$(inside node --version), npm $(inside npm --version)"
    row 'Python and Node' "installed in $(since "$started")"
    run_command second "$second"
  fi
  section
  rm -rf --one-file-system "$root"
}
version() { inside dpkg-query --show --showformat '${Version}' "$1"; } # PACKAGE

section() { # appends the results of this suite
  {
    printf '\n## Debian %s\n\n| | |\n|---|---|\n' "$suite"
    printf '%s\n' "${rows[@]}"
    if [ -f "$root$checkout/target/tests/summary" ]; then
      printf '\nThe summary of `scripts/test.sh`:\n\n```text\n'
      fold -s -w 150 "$root$checkout/target/tests/summary"
      printf '```\n'
    fi
  } >>"$place/sections"
}

mkdir -p "$place"
failed=''
: >"$place/sections"
for suite in "${suites[@]}"; do try "$suite"; done
if [ -z "$only_first" ]; then
  {
    printf '# The two commands on a plain machine\n\n'
    printf 'Written by `scripts/plain_machine.sh`. It runs the two commands of the README in a minimal Debian, as a user without sudo, with\n'
    printf 'nothing installed but what the README names.\n\n'
    printf 'Commit %s, %s, %s cores of %s.\n\n' "$commit" "$(date -u +%F)" "$(nproc)" "$(sed -n 's/^model name\s*: //p;T;q' /proc/cpuinfo)"
    printf '```sh\n%s\n%s\n```\n' "$first" "$second"
    cat "$place/sections"
  } >docs/plain-machine.md
  say 'docs/plain-machine.md is written'
fi
rm -f "$place/sections"
[ -z "$failed" ] || { say 'FAILED'; exit 1; }

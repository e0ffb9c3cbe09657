#!/usr/bin/env bash
# Makes a compiler for wasm32-unknown-unknown where `rustup target add` cannot reach its server: from the packages of Debian
# 12 or later for 64-bit Intel, which have the compiler and the sources of the standard library but not the library itself
# for this target. Nothing is installed, and root is not needed.
#   scripts/wasm-toolchain.sh FOLDER
#   RUSTC=FOLDER/bin/rustc cargo build --target wasm32-unknown-unknown
# Needs cargo, rustup with a stable toolchain (for its linker), and the network for packages. A folder that is complete stays.
set -euo pipefail
if [ $# -ne 1 ]; then sed -n '2,/^set/s/^# \{0,1\}//p' "$0" >&2; exit 2; fi
mkdir -p "$1"
folder=$(cd "$1" && pwd)
if [ -f "$folder/complete" ]; then exit; fi

target=wasm32-unknown-unknown host=x86_64-unknown-linux-gnu
as_root=''
if [ "$(id -u)" -ne 0 ] && command -v sudo >/dev/null; then as_root=sudo; fi
$as_root apt-get update -qq || echo 'package lists are not refreshed' >&2

# The compiler, its shared library, LLVM as the compiler was linked with it, and the sources of the standard library.
first_dependency() { # PACKAGE PATTERN: the first package it depends on whose name matches
  apt-cache depends "$1" | awk -v pattern="$2" '$1 ~ /^\|?Depends:$/ && $2 ~ pattern { print $2; exit }'
}
driver=$(first_dependency libstd-rust-web-dev '^libstd-rust-web-[0-9.]+$')
llvm=$(first_dependency "$driver" '^libllvm[0-9]+$')
packages=$(mktemp -d "$folder/packages.XXXXXX")
trap 'rm -rf "$packages"' EXIT
(cd "$packages" && apt-get download -qq rustc-web libstd-rust-web-dev "$driver" "$llvm" rust-web-src)
for package in "$packages"/*.deb; do
  case $package in
    */rust-web-src_*) # the library only, a sixth of the sources
      dpkg-deb --fsys-tarfile "$package" | tar -x -C "$folder" --wildcards './usr/src/rustc-*/library/*' ;;
    *) dpkg-deb --extract "$package" "$folder" ;;
  esac
done

# The compiler finds its libraries beside it, and rustup's linker where it looks for its own.
mkdir -p "$folder/bin"
cat > "$folder/bin/rustc" <<WRAPPER
#!/bin/sh
LD_LIBRARY_PATH="$folder/usr/lib/x86_64-linux-gnu\${LD_LIBRARY_PATH:+:\$LD_LIBRARY_PATH}" exec "$folder/usr/bin/rustc" "\$@"
WRAPPER
chmod +x "$folder/bin/rustc"
linker=lib/rustlib/$host/bin/rust-lld
mkdir -p "$folder/usr/$(dirname "$linker")"
ln -sf "$(rustup run stable rustc --print sysroot)/$linker" "$folder/usr/$linker"

# The standard library, built as the distribution would build it.
sources=$(echo "$folder"/usr/src/rustc-*/library)
env -u RUSTC_WRAPPER RUSTC="$folder/bin/rustc" RUSTC_BOOTSTRAP=1 __CARGO_DEFAULT_LIB_METADATA=stablestd \
  RUSTFLAGS='-Zforce-unstable-if-unmarked -Cembed-bitcode=yes -Cdebuginfo=0' \
  cargo build --quiet --release --locked --target "$target" --target-dir "$folder/std" \
  --manifest-path "$sources/sysroot/Cargo.toml" --features 'panic-unwind compiler-builtins-mem'
libraries=$folder/usr/lib/rustlib/$target/lib
mkdir -p "$libraries"
find "$folder/std/$target/release/deps" -name '*.rlib' ! -name 'libsysroot-*' -exec cp {} "$libraries" \;
rm -rf "$folder/std"
touch "$folder/complete"
"$folder/bin/rustc" --version

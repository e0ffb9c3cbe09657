#!/usr/bin/env bash
# Prints the path of a compiler that has the standard library for each TARGET: rustup's, where it has them or `rustup target add` can
# fetch them; otherwise one that is made in FOLDER from the packages of Debian 12 or later for 64-bit Intel, which have the compiler
# and the sources of the standard library but not the library itself for these targets. Nothing is installed, and root is not needed.
#   rustc=$(scripts/toolchain.sh FOLDER TARGET...)
#   RUSTC=$rustc cargo build --target TARGET --target-dir ...     # a folder of its own, as it may be another compiler
# For systems whose programs cannot be linked on Linux (Windows, macOS, iOS, Android) the library that is made serves `cargo check` only;
# for Linux on another processor the caller names a linker (CARGO_TARGET_..._LINKER). Needs cargo, rustup with a stable toolchain (for its
# linker of WebAssembly), and the network for packages. What is complete in FOLDER stays.
set -euo pipefail
if [ $# -lt 2 ]; then sed -n '2,/^set/s/^# \{0,1\}//p' "$0" >&2; exit 2; fi
mkdir -p "$1"
folder=$(cd "$1" && pwd)
shift
host=x86_64-unknown-linux-gnu

missing=() # targets for which rustup has no library yet
installed=$(rustup target list --installed)
for target in "$@"; do
  grep -qx "$target" <<<"$installed" || missing+=("$target")
done
made() { [ -f "$folder/complete/$1" ]; }
all_made() { for target in "${missing[@]}"; do made "$target" || return 1; done; }
if [ ${#missing[@]} -eq 0 ] || { ! all_made && rustup target add "${missing[@]}" >&2; }; then
  rustup which rustc
  exit
fi

# The compiler, its shared library, LLVM as the compiler was linked with it, and the sources of the standard library.
first_dependency() { # PACKAGE PATTERN: the first package it depends on whose name matches
  apt-cache depends "$1" | awk -v pattern="$2" '$1 ~ /^\|?Depends:$/ && $2 ~ pattern { print $2; exit }'
}
unpack_compiler() {
  local as_root='' driver llvm package linker=lib/rustlib/$host/bin/rust-lld
  if [ "$(id -u)" -ne 0 ] && command -v sudo >/dev/null; then as_root=sudo; fi
  $as_root apt-get update -qq || echo 'package lists are not refreshed' >&2
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

  # A library that is shared needs a linker for the target, and nothing links it.
  sed -i 's/^crate-type = \["dylib", "rlib"\]/crate-type = ["rlib"]/' "$folder"/usr/src/rustc-*/library/std/Cargo.toml

  # It finds its libraries beside it, and rustup's linker where it looks for its own.
  mkdir -p "$folder/bin" "$folder/usr/$(dirname "$linker")" "$folder/complete"
  cat > "$folder/bin/rustc" <<WRAPPER
#!/bin/sh
LD_LIBRARY_PATH="$folder/usr/lib/x86_64-linux-gnu\${LD_LIBRARY_PATH:+:\$LD_LIBRARY_PATH}" exec "$folder/usr/bin/rustc" "\$@"
WRAPPER
  chmod +x "$folder/bin/rustc"
  ln -sf "$(rustup run stable rustc --print sysroot)/$linker" "$folder/usr/$linker"
  touch "$folder/complete/compiler"
}

# The standard library, built as the distribution would build it, or only what a check reads of it.
build_library() { # TARGET
  local target=$1 command=build what='*.rlib' features='panic-unwind backtrace' sources
  case $target in
    wasm32-*) features='panic-unwind compiler-builtins-mem' ;;
    *-linux-gnu*) ;;
    *) command=check what='*.rmeta' ;;
  esac
  sources=$(echo "$folder"/usr/src/rustc-*/library)
  env -u RUSTC_WRAPPER RUSTC="$folder/bin/rustc" RUSTC_BOOTSTRAP=1 __CARGO_DEFAULT_LIB_METADATA=stablestd \
    RUSTFLAGS='-Zforce-unstable-if-unmarked -Cembed-bitcode=yes -Cdebuginfo=0' \
    cargo "$command" --quiet --release --locked --target "$target" --target-dir "$folder/std" \
    --manifest-path "$sources/sysroot/Cargo.toml" --features "$features" >&2
  local libraries=$folder/usr/lib/rustlib/$target/lib
  rm -rf "$libraries"
  mkdir -p "$libraries"
  find "$folder/std/$target/release/deps" -name "$what" ! -name 'libsysroot-*' -exec cp {} "$libraries" \;
  rm -rf "$folder/std"
  touch "$folder/complete/$target"
}

made compiler || unpack_compiler
for target in "$@"; do # all of them, as one compiler serves them
  made "$target" || [ "$target" = "$host" ] || build_library "$target"
done
echo "$folder/bin/rustc"

#!/usr/bin/env bash
# Compares the bits of environments across numbers of threads, profiles, instruction sets, processors and WebAssembly, and prints a table of Markdown.
#   scripts/same_bits.sh [ROW...]      # all rows, or those named: scripts/same_bits.sh threads wasm
# Rows: threads debug avx2 avx512 nehalem i686 aarch64 riscv64 s390x wasm wasm-simd128. Each builds the example `checksum` for its
# target and compares its lines (episodes, tasks and variants, vectors, snapshots, pictures) with those of one thread of a release build for every x86-64.
# It restores the snapshots that this build wrote and continues, and this build restores those of the row. An emulated processor computes a
# step as long as this one computes fifty, so episodes end after 10 steps there. Other processors need Debian's qemu-user-static (of
# backports, or of Debian 13, for s390x) and gcc-ARCH-linux-gnu; a row that cannot run on this machine says why. PROGRAM names a release
# build of the example that is there already. The result is in docs/same-bits.md.
set -euo pipefail
cd "$(dirname "$0")/.."
target=${CARGO_TARGET_DIR:-$PWD/target}
host=x86_64-unknown-linux-gnu wasm=wasm32-unknown-unknown
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
all=(threads debug avx2 avx512 nehalem i686 aarch64 riscv64 s390x wasm wasm-simd128)
for row in "$@"; do
  [[ " ${all[*]} " == *" $row "* ]] || { echo "scripts/same_bits.sh: there is no row $row; ${all[*]}" >&2; exit 2; }
done
[ $# -gt 0 ] || set -- "${all[@]}"

# Programs for other processors hold their C library.
build() { # NAME TARGET FLAGS PROFILE: prints the path of a program or module, target/same-bits/NAME
  local name=$1 for=$2 flags=$3 profile=$4 rustc made variable=${2//-/_}
  made=$target/$for/${profile/dev/debug}/examples/checksum
  local what=(-p babybench --features parallel --example checksum)
  if [ "$for" = "$wasm" ]; then what=(-p checksum-wasm) made=$target/$for/${profile/dev/debug}/checksum_wasm.wasm; fi
  rustc=$(scripts/toolchain.sh "$target/toolchain" "$for")
  env RUSTC="$rustc" "CARGO_TARGET_${variable^^}_RUSTFLAGS=$flags" "CARGO_TARGET_${variable^^}_LINKER=$(linker "$for")" \
    cargo build --quiet --locked "${what[@]}" --profile "$profile" --target "$for" --target-dir "$target" >&2
  mkdir -p "$target/same-bits"
  cp "$made" "$target/same-bits/$name"
  echo "$target/same-bits/$name"
}
linker() { # TARGET
  case $1 in
    "$host") echo cc ;;
    "$wasm") echo rust-lld ;;
    *) echo "$(processor "$1")-linux-gnu-gcc" ;;
  esac
}
processor() { # TARGET: its name in Debian
  local name=${1%%-*}
  echo "${name/riscv64gc/riscv64}"
}

# Lines of the program, run in its emulator with these threads and steps.
lines() { # COMMAND THREADS LONGEST: all kinds
  local kind
  for kind in episode variant vector; do $1 $kind "$2" "$3" || return; done
  for kind in snapshot picture; do $1 $kind "$2" || return; done
}
module_lines() { # COMMAND
  local kind
  for kind in episode variant vector snapshot picture; do $1 "$kind" || return; done
}

wrong=0
say() { echo "| $1 | $2 | $3 | $4 | $5 |"; }
row() { # NAME COMMAND LINES...: compares what LINES prints, and exchanges snapshots with COMMAND
  local name=$1 command=$2 lines equal kept restored total
  shift 2
  rm -rf "$folder/kept"
  mkdir "$folder/kept"
  if ! { "$@" >"$folder/found" && $command keep "$folder/kept" && $command restore "$folder/measure-kept" >"$folder/restored" &&
    $measure restore "$folder/kept" >>"$folder/restored"; }; then
    wrong=1
    say "$name" failed '' '' ''
    return
  fi
  lines=$(wc -l <"$folder/found") equal=$(grep -cxFf "$folder/measure" "$folder/found" || true)
  total=$(find "$folder/measure-kept" -type f | wc -l)
  kept=$(cd "$folder/kept" && for file in *; do cmp -s "$file" "$folder/measure-kept/$file" && echo "$file"; done | wc -l)
  restored=$(grep -cxFf "$folder/measure" "$folder/restored" || true)
  if [ "$lines" != "$equal" ] || [ "$lines" -lt 53 ] || [ "$kept" != "$total" ] || [ "$restored" != $((2 * total)) ]; then
    wrong=1
    grep -vxFf "$folder/measure" "$folder/found" "$folder/restored" | sed "s/^/$name differs: /" >&2 || true
  fi
  say "$name" "$lines" "$equal" "$kept of $total" "$restored of $((2 * total))"
}
emulated() { # NAME TARGET
  local name=$1 emulator program
  emulator=qemu-$(processor "$2")-static
  if ! command -v "$emulator" >/dev/null || ! command -v "$(linker "$2")" >/dev/null; then
    say "$name" "not run: needs $emulator and $(linker "$2")" '' '' ''
    return
  fi
  if [ "${2%%-*}" = s390x ] && [ "$("$emulator" --version | sed -n 's/^qemu.* version \([0-9]*\).*/\1/p')" -lt 8 ]; then
    # MDEBR, which multiplies in single precision with a result in double, takes its second factor for a double
    say "$name" "not run: $emulator is older than QEMU 8, which multiplies wrongly" '' '' ''
    return
  fi
  program=$(build "${2%%-*}" "$2" '-C target-feature=+crt-static' release)
  row "$name, by qemu-user" "$emulator $program" lines "$emulator $program" 1 10
}
has() { grep -qw "$1" /proc/cpuinfo; }

measure=${PROGRAM:-$(build measure "$host" '' release)}
lines "$measure" 1 1000 >"$folder/measure"
lines "$measure" 1 10 >>"$folder/measure"
mkdir "$folder/measure-kept"
$measure keep "$folder/measure-kept"
echo "Commit $(git describe --always --dirty), $(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -1)."
echo
echo '| where | lines | equal | snapshots with equal bytes | restored, from there and there |'
echo '|---|--:|--:|--:|--:|'
for row in "$@"; do
  case $row in
    threads)
      row '2 threads' "$measure" lines "$measure" 2 1000
      row '7 threads' "$measure" lines "$measure" 7 1000 ;;
    debug)
      program=$(build debug "$host" '' dev)
      row 'without optimisation, 2 threads' "$program" lines "$program" 2 100 ;;
    avx2)
      if ! has avx2 || ! has fma; then say 'built for AVX2 and FMA (x86-64-v3)' 'not run: this processor lacks them' '' '' ''; continue; fi
      program=$(build avx2 "$host" '-C target-cpu=x86-64-v3' release)
      row 'built for AVX2 and FMA (x86-64-v3)' "$program" lines "$program" 2 1000 ;;
    avx512)
      if ! has avx512vl; then say 'built for AVX-512 (x86-64-v4)' 'not run: this processor lacks it' '' '' ''; continue; fi
      program=$(build avx512 "$host" '-C target-cpu=x86-64-v4' release)
      row 'built for AVX-512 (x86-64-v4)' "$program" lines "$program" 2 1000 ;;
    nehalem) # what every x86-64 has, and SSE 4
      emulator='qemu-x86_64-static -cpu Nehalem'
      if ! command -v qemu-x86_64-static >/dev/null; then say 'processor without AVX' 'not run: needs qemu-x86_64-static' '' '' ''; continue; fi
      row 'a processor without AVX (Nehalem), by qemu-user' "$emulator $measure" lines "$emulator $measure" 1 10 ;;
    i686)
      if ! command -v i686-linux-gnu-gcc >/dev/null; then say i686 'not run: needs i686-linux-gnu-gcc' '' '' ''; continue; fi
      program=$(build i686 i686-unknown-linux-gnu '-C target-feature=+crt-static' release)
      row 'i686' "$program" lines "$program" 2 1000 ;;
    aarch64) emulated 'aarch64' aarch64-unknown-linux-gnu ;;
    riscv64) emulated 'riscv64' riscv64gc-unknown-linux-gnu ;;
    s390x) emulated 's390x (big-endian)' s390x-unknown-linux-gnu ;;
    wasm | wasm-simd128)
      flags='' name='WebAssembly in node'
      if [ "$row" = wasm-simd128 ]; then flags='-C target-feature=+simd128' name="$name, with simd128"; fi
      module="node examples/checksum/run.mjs $(build "$row" "$wasm" "$flags" release)"
      row "$name" "$module" module_lines "$module" ;;
  esac
done
exit $wrong

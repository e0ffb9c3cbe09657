#!/usr/bin/env bash
# Runs all protocols with held and coloured noise, and writes docs/protocols.md with their tables and docs/protocols/NAME.svg with their figures.
#   scripts/protocols.sh [LENGTH [SEEDS]]    # 0.1 of the length and 3 seeds by default: some minutes
# PROGRAM names a build of the program that is there already.
set -euo pipefail
cd "$(dirname "$0")/.."
length=${1:-0.1} seeds=${2:-3}
program=${PROGRAM:-}
if [ -z "$program" ]; then
  cargo build --quiet --locked --release -p babybench-cli
  program=${CARGO_TARGET_DIR:-target}/release/babybench
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
commit=$(git rev-parse --short=8 HEAD)
mkdir -p docs/protocols
{
  echo '# Experiments beside infants'
  echo
  echo "All [protocols](guide/protocols.md) with held noise and with the coloured noise of MIMo's age, at $length of their length, from $seeds seeds; commit"
  echo "$commit. Noise wants nothing: these tables say what chance gives, and other policies can be compared with them."
  echo "\`scripts/protocols.sh\` makes this page."
} > "$folder/page.md"
for name in $("$program" protocol list | cut -d ' ' -f 1); do
  "$program" protocol run "$name" --policy held --policy color_by_age --seeds "$seeds" --length "$length" --out "$folder/$name" --quiet > /dev/null
  cp "$folder/$name/figure.svg" "docs/protocols/$name.svg"
  {
    echo
    # one level down, with the figure below the title
    sed 's/^#/##/' "$folder/$name/protocol.md" | sed "1a\\
\\
![Measures of MIMo with both noises, and published numbers in grey](protocols/$name.svg)"
  } >> "$folder/page.md"
done
mv "$folder/page.md" docs/protocols.md

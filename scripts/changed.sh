#!/usr/bin/env bash
# Prints which parts of the tests the changes concern that this checkout has against another one, committed or not: rust, python, web, fuzz.
#   scripts/changed.sh [COMMIT]    # main by default, or origin/main where there is no main
# All of them where nothing differs, as on main itself, and where there is no such commit.
set -euo pipefail
cd "$(dirname "$0")/.."
every='rust python web fuzz'
main=${1:-$(git rev-parse --quiet --verify --abbrev-ref main || git rev-parse --quiet --verify --abbrev-ref origin/main || true)}
base=$(git merge-base HEAD "${main:-none}" 2>/dev/null) || { echo "$every"; exit; }
files=$(git diff --name-only "$base" && git ls-files --others --exclude-standard)
if [ -z "$files" ]; then echo "$every"; exit; fi

declare -A parts=()
while read -r file; do
  case $file in
    web/crate/* | web/onnx/* | web/bindgen/*) concerns='rust web' ;; # members of the workspace
    web/*) concerns=web ;;
    python/*.rs | python/Cargo.toml) concerns='rust python' ;;
    python/*) concerns=python ;;
    fuzz/*) concerns=fuzz ;;
    examples/checksum/*) concerns='rust web' ;; # whose bits the package has, too
    cli/*) concerns='rust python' ;; # the wheel has it, too
    conformance/* | tests/* | testkit/* | benches/* | examples/*) concerns=rust ;;
    .github/* | CHANGELOG.md | changes/* | towncrier.toml | CODE_OF_CONDUCT.md | CONTRIBUTING.md | SECURITY.md | LICENSE-* | NOTICE | _typos.toml | deny.toml)
      concerns='' ;;
    docs/tutorials/* | docs/guide/surprises.md | docs/guide/known-faults.md) concerns='rust python web' ;; # their programs run
    docs/* | *.md) concerns=rust ;; # programs in the README run, the guide's tables are compared
    *) concerns=$every ;;
  esac
  for part in $concerns; do parts[$part]=yes; done
done <<<"$files"
for part in $every; do if [ -n "${parts[$part]:-}" ]; then echo -n "$part "; fi; done
echo

#!/usr/bin/env bash
# Publishes a release: the crates to crates.io, the Python packages to PyPI, the npm package to npm.
#   scripts/publish.sh --dry-run [PART...]        # uploads nothing: packages every part here, and builds each crate from its own archive
#   scripts/publish.sh --files FOLDER [PART...]   # uploads; FOLDER has the files of the release that .github/workflows/release.yml drafts
# PART is crates, python or npm, all three by default. Crates are the packages of the workspace that may be published, those that others
# need first: each is built with those before it as crates.io would serve them. A crate or a file that is there already is left out, so that a release
# which broke off can go on. All packages must have one version, and what is uploaded is the commit that has its tag.
# Needs cargo and Python 3.11 with venv; for npm, node, and in a dry run web/dist (web/build.sh); and the network. Who uploads is logged in:
# cargo login, a token for twine (TWINE_USERNAME, TWINE_PASSWORD or ~/.pypirc), npm login.
set -euo pipefail
cd "$(dirname "$0")/.."
usage() { sed -n '2,/^set/s/^# \{0,1\}//p' "$0" >&2; exit 2; }
fail() { echo "scripts/publish.sh: $1" >&2; exit 1; }
every='crates python npm' dry='' files='' parts=''
while [ $# -gt 0 ]; do
  case $1 in
    --dry-run) dry=yes ;;
    --files) [ $# -gt 1 ] || usage; files=$2; shift ;;
    crates | python | npm) parts="$parts $1" ;;
    *) usage ;;
  esac
  shift
done
if [ -n "$dry" ]; then [ -z "$files" ] || usage; else [ -d "$files" ] || usage; fi
work=${CARGO_TARGET_DIR:-$PWD/target}/publish
mkdir -p "$work"
title() { echo; echo "=== $1"; }

# The version, and the crates in their order; packages whose version is another one.
listing=$(cargo metadata --format-version 1 --no-deps --locked | python3 -c '
import graphlib, json, re, sys, tomllib
from pathlib import Path

packages = {package["name"]: package for package in json.load(sys.stdin)["packages"]}
crates = {name: package for name, package in packages.items() if package["publish"] != []}
needs = {
    name: [need["name"] for need in package["dependencies"] if need["name"] in crates and need["kind"] != "dev"]
    for name, package in crates.items()
}
kit = tomllib.loads(Path("python/kit/pyproject.toml").read_text("utf-8"))["project"]
versions = {f"crate {name}": package["version"] for name, package in crates.items()}
versions["Python package babybench (python/Cargo.toml)"] = packages["babybench-python"]["version"]
versions["Python package babybench-kit"] = kit["version"]
for need in kit["dependencies"]:
    if match := re.fullmatch("babybench==(.*)", need):
        versions["the babybench that babybench-kit needs"] = match[1]
versions["npm package babybench"] = json.loads(Path("web/package/package.json").read_text("utf-8"))["version"]
if len(set(versions.values())) > 1:
    sys.exit("scripts/publish.sh: packages have several versions:\n" + "\n".join(f"  {version} {what}" for what, version in versions.items()))
print(versions["npm package babybench"], *graphlib.TopologicalSorter(needs).static_order())
')
read -r -a crates <<<"$listing"
version=${crates[0]}
crates=("${crates[@]:1}")
if [ -z "$dry" ] && [ "$(git describe --exact-match --tags 2>/dev/null)" != "v$version" ]; then
  fail "the packages have the version $version, but this commit has no tag v$version: git checkout v$version"
fi
echo "version $version"

publish_crates() {
  local crate wanted=()
  for crate in "${crates[@]}"; do
    if [ -z "$dry" ] && cargo info --quiet --registry crates-io "$crate@$version" >/dev/null 2>&1; then
      echo "$crate $version is on crates.io already"
    else
      wanted+=(--package "$crate")
    fi
  done
  echo "in order: ${crates[*]}"
  [ ${#wanted[@]} -gt 0 ] || return 0
  if [ -z "$dry" ]; then
    cargo publish --locked "${wanted[@]}"
  else
    cargo package --locked "${wanted[@]}"
    local archives=${CARGO_TARGET_DIR:-target}/package
    for crate in "${crates[@]}"; do
      echo "$crate-$version.crate: $(tar -tzf "$archives/$crate-$version.crate" | wc -l) files, $(($(wc -c <"$archives/$crate-$version.crate") / 1000)) kB"
    done
  fi
}

publish_python() {
  local from=$files
  [ -d "$work/tools" ] || python3 -m venv "$work/tools"
  "$work/tools/bin/pip" install --quiet --disable-pip-version-check twine==7.0.0
  if [ -n "$dry" ]; then
    from=$work/python
    rm -rf "$from"
    scripts/wheels.sh --out "$from" sdist kit native
  fi
  # The kit's last: pip must find what it needs.
  local distributions=("$from"/babybench-"$version"*.whl "$from/babybench-$version.tar.gz" "$from"/babybench_kit-"$version"{-*.whl,.tar.gz}) file
  for file in "${distributions[@]}"; do [ -f "$file" ] || fail "$file is missing"; done
  "$work/tools/bin/twine" check --strict "${distributions[@]}"
  [ -n "$dry" ] || "$work/tools/bin/twine" upload --skip-existing "${distributions[@]}"
}

publish_npm() {
  local archive=$files/babybench-$version.tgz
  if [ -n "$dry" ]; then
    npm pack ./web/dist/babybench --pack-destination "$work" >/dev/null
    archive=$work/babybench-$version.tgz
  fi
  [ -f "$archive" ] || fail "$archive is missing"
  npm publish ${dry:+--dry-run} "$(realpath "$archive")"
}

for part in ${parts:-$every}; do
  title "$part"
  if [ "$part" = npm ] && [ -n "$dry" ] && [ ! -d web/dist/babybench ]; then
    [ -z "$parts" ] || fail 'web/dist is not built: web/build.sh'
    echo 'left out: web/dist is not built (web/build.sh)'
    continue
  fi
  "publish_$part"
done

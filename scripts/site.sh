#!/usr/bin/env bash
# Builds the project's site, which any static host serves, into target/site/html: the book (docs/), the references of Rust, Python and
# JavaScript, the live page, and a search over all of it. Checks the links in and between them, and the figures that pages quote.
#   scripts/site.sh            # everything
#   scripts/site.sh quick      # the book alone, with its links and figures
#   scripts/site.sh serve [PORT]   # serves what was built, on this machine
# Needs Node 20 and Python 3.11 with venv; for everything also Rust, and the network. SITE_BASE is the path that the site will have on its
# host, / by default. BABYBENCH_PYTHON names a Python that has babybench, babybench-kit and pdoc; without it one is made.
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD tools=docs/site out=$PWD/target/site/html sources=$PWD/target/site/pages

if [ "${1:-}" = serve ]; then
  if ! [ -f "$out/index.html" ]; then echo 'scripts/site.sh: there is no site yet; build it with scripts/site.sh' >&2; exit 1; fi
  exec python3 -m http.server "${2:-8000}" --bind 127.0.0.1 --directory "$out"
fi
case ${1:-} in
  '' | quick) ;;
  *) echo "scripts/site.sh: unknown argument $1; quick, serve or none" >&2; exit 2 ;;
esac

python3 scripts/figures.py
if ! [ -d "$tools/node_modules" ] || [ "$tools/package-lock.json" -nt "$tools/node_modules" ]; then
  npm ci --prefix "$tools" --ignore-scripts --no-audit --no-fund
  touch "$tools/node_modules"
fi

book() { # [quick]: without colours in programs, which take a third of the time
  local version commit
  version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -1)
  commit=$(git rev-parse --short HEAD 2>/dev/null || true)
  export SITE_VERSION="$version${commit:+ ($commit)}" SITE_SOURCE=$sources SITE_OUT=$out
  if [ "${1:-}" = quick ]; then export SITE_QUICK=yes; fi
  node "$tools/assemble.mjs" "$sources"
  ln -sfn "$root/$tools/node_modules" "$(dirname "$sources")/node_modules" # where pages find Vue
  rm -rf "$out"
  "$tools/node_modules/.bin/vitepress" build "$tools"
}
rust_reference() {
  RUSTDOCFLAGS='-D warnings' cargo doc --locked --release --no-deps --all-features -p babybench -p mjcf-sim -p mjcf-sim-model -p mjcf-sim-loader \
    -p mjcf-sim-physics -p mjcf-sim-render -p mjcf-sim-rapier
  mkdir -p "$out/reference"
  rm -rf "$out/reference/rust"
  cp -r "${CARGO_TARGET_DIR:-target}/doc" "$out/reference/rust"
}
python_reference() {
  local python=${BABYBENCH_PYTHON:-}
  if [ -z "$python" ]; then
    python=$root/target/site/python/bin/python
    python3 -m venv target/site/python
    "$python" -m pip install --quiet --disable-pip-version-check ./python ./python/kit pdoc==16.0.0 matplotlib
  fi
  rm -rf "$out/reference/python"
  (cd target/site && "$python" "$root/python/docs/build.py" "$out/reference/python")
}
javascript_reference() {
  if [ -z "${SITE_WEB:-}" ]; then web/build.sh; fi
  rm -rf "$out/live" "$out/reference/npm"
  cp -r web/dist "$out/live"
  "$tools/node_modules/.bin/typedoc" --options "$tools/typedoc.json" --out "$out/reference/npm"
}

book "${1:-}"
if [ "${1:-}" != quick ]; then
  rust_reference
  python_reference
  javascript_reference
  "$tools/node_modules/.bin/pagefind" --site "$out" --output-path "$out/pagefind" \
    --exclude-selectors '.lang, .copy, .VPSidebar, .VPLocalNav, .VPDocFooter, rustdoc-toolbar, .sidebar'
fi
# Links to other hosts are not checked: a site is no worse for a host that is down.
skipped=(--skip '^https?://(?!localhost)')
if [ "${1:-}" = quick ]; then skipped+=(--skip '/(reference|live|pagefind)/'); fi
"$tools/node_modules/.bin/linkinator" "${out#"$root/"}" --recurse --check-fragments "${skipped[@]}" --verbosity error
echo "the site is in $out: scripts/site.sh serve"

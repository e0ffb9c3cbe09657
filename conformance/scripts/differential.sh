#!/usr/bin/env bash
# Compares random documents with MuJoCo, and writes docs/differential.md.
#   conformance/scripts/differential.sh [DOCUMENTS] [FIRST_SEED]     100,000 documents from seed 1 on
# Writes documents that differ, reduced, into target/differential/.
set -euo pipefail
cd "$(dirname "$0")/../.."
documents=${1:-100000} seed=${2:-1}

conformance/scripts/fetch_mujoco.sh
cargo build --locked --release -p conformance
commit=$(git rev-parse --short HEAD)
if [ -n "$(git status --porcelain -- src Cargo.toml Cargo.lock)" ]; then commit="$commit, with changes"; fi
table=$(mktemp)
code=0
target/release/conformance differential --count "$documents" --seed "$seed" --keep target/differential > "$table" || code=$?
{
  echo '# Random documents beside MuJoCo 3.3.0'
  echo
  echo 'Random legal documents over everything that the loader understands, compared with MuJoCo: three random states of each, and one step on both sides from the'
  echo 'same state. `conformance/scripts/differential.sh` writes this page. `conformance/src/differential/` defines how documents and states are drawn and what is'
  echo 'compared.'
  echo
  echo 'The following states are left out and counted below:'
  echo
  echo '- MuJoCo warns or gives up.'
  echo '- The inertia is ill-conditioned (scaled condition above 1e8), or a row has hardly any regularisation (below 1e-13) or a Jacobian of rounding errors (below'
  echo '  1e-12).'
  echo '- MuJoCo itself jumps as far when the last bits of the positions change.'
  echo '- Conjugate gradients end at their limit of iterations.'
  echo
  echo 'Where a quantity differs, the quantities that follow from it are not compared. Documents run in processes of their own, because some make MuJoCo access'
  echo 'invalid memory.'
  echo
  echo "Commit $commit, $(date -u +%F), seed $seed."
  echo
  grep '^|\|^$' "$table" | cat -s | sed '$ { /^$/d }'
} > docs/differential.md
rm -f "$table"
exit $code

#!/usr/bin/env bash
# Puts random documents beside MuJoCo, and writes the table of docs/differential.md.
#   conformance/scripts/differential.sh [DOCUMENTS] [FIRST_SEED]     100,000 documents from seed 1 on
# Documents that differ are written, made small, into target/differential/.
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
  echo 'Written by `conformance/scripts/differential.sh`, not by hand: random legal documents over all that the loader understands, three random'
  echo 'states of each, one step on both sides from the same state. `conformance/src/differential/` says how documents and states are drawn and what'
  echo 'is compared. Left out, and counted below, are states in which MuJoCo warns or gives up; those whose inertia is ill-conditioned (scaled'
  echo 'condition above 1e8), or in which a row has hardly any regularisation (below 1e-13) or a Jacobian of rounding errors (below 1e-12);'
  echo 'those in which MuJoCo itself jumps as far when the last bits of the positions change; and those in which conjugate gradients'
  echo 'end at their limit of iterations. Where a quantity differs, those that follow from it are not compared.'
  echo 'Documents run in processes of their own, as at some of them MuJoCo reads or writes memory that is not its.'
  echo
  echo "Commit $commit, $(date -u +%F), seed $seed."
  echo
  grep '^|\|^$' "$table" | cat -s
} > docs/differential.md
rm -f "$table"
exit $code

#!/usr/bin/env bash
# Checks the form of all Markdown files: no line over 160 characters, tables whose rows fit, well-formed headings, lists and code blocks.
#   scripts/markdown.sh          # all files; .markdownlint-cli2.jsonc has the rules
#   scripts/markdown.sh --fix    # mends what can be mended without a person
# Needs Node 20, and once the network for markdownlint-cli2.
set -euo pipefail
cd "$(dirname "$0")/.."
exec npx --yes markdownlint-cli2@0.22.1 "$@"

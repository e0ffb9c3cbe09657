# shellcheck shell=bash
# Sourced by the test scripts. Runs steps one after the other, times them, counts their tests, and prints a summary at the end. A step that
# fails does not stop the following ones.
#   steps_of PART           sets the part that the following steps belong to
#   step NAME COMMAND...    runs a command or a function under `set -e` and records the result; never call it in a condition
#   must NAME COMMAND...    the same, but ends the script if the step fails
#   call PART COMMAND...    runs a script that has steps of its own
#   lack NAME REASON        records that this machine cannot run a step: ignored, or failed if BABYBENCH_TESTS=required
#   finish                  ends the script, with status 1 if a step failed; the outermost script prints the summary
# target/tests holds `results` and `ignored` (tab-separated), `summary`, and a log for each step. Nested scripts find the folder in
# BABYBENCH_NOTES.

outermost=''
if [ -z "${BABYBENCH_NOTES:-}" ]; then
  outermost=yes
  export BABYBENCH_NOTES=$PWD/target/tests
  rm -rf "$BABYBENCH_NOTES"
  mkdir -p "$BABYBENCH_NOTES"
  : >"$BABYBENCH_NOTES/results"
  : >"$BABYBENCH_NOTES/ignored"
fi
notes=$BABYBENCH_NOTES
script_started=$SECONDS
# Cargo does not see the terminal through the pipe into the log.
if [ -t 1 ]; then export CARGO_TERM_PROGRESS_WHEN=always CARGO_TERM_PROGRESS_WIDTH=${COLUMNS:-80}; fi

part=""
steps_of() { part=$1; }

duration() { printf '%d min %02d s' $(($1 / 60)) $(($1 % 60)); } # SECONDS

note() { # NAME RESULT SECONDS DETAIL [SECONDS OF PROCESSORS]
  printf '%s\t%s\t%s\t%s\t%s\t%s\n' "$part" "${@:1:3}" "${5:-0}" "$4" >>"$notes/results"
}

# Adds up the closing lines of cargo test, pytest and node's test runner. Prints "12 passed, 1 failed, 3 ignored", or nothing.
counts() { # LOG
  awk '
    function add(number, word) {
      if (word ~ /^(passed|pass)/) passed += number
      else if (word ~ /^(failed|fail|error)/) failed += number
      else if (word ~ /^(ignored|skipped)/) ignored += number
      else return
      found = 1
    }
    /(passed|failed|skipped|errors?)[;,]? .*in [0-9.]+s/ { for (i = 1; i < NF; i++) if ($i ~ /^[0-9]+$/) add($i, $(i + 1)) }
    /^(#|ℹ) (pass|fail|skipped) [0-9]+$/ { add($3, $2) }
    END {
      if (!found) exit
      printf "%d passed", passed
      if (failed) printf ", %d failed", failed
      if (ignored) printf ", %d ignored", ignored
    }' "$1"
}

# Lists the tests that the runners skipped: how many, and why.
reasons() { # LOG
  local tab=$'\t'
  sed -nE \
    -e "s/^ignored: [^ ]+: (.*)\$/1$tab\1/p" \
    -e "s/^test [^[]* \.\.\. ignored, (.*)\$/1$tab\1/p" \
    -e "s/^SKIPPED \[([0-9]+)\] [^ ]+: (.*)\$/\1$tab\2/p" \
    -e "s/^ *ok [0-9]+ - .* # SKIP ?(.*)\$/1$tab\1/p" \
    -e "s/^ *﹣ .* \([0-9.]+ms\) # (.*)\$/1$tab\1/p" "$1"
}

# Sets `processor` to the seconds of processor time that this shell has waited for.
count_processor_time() {
  local user system file=$notes/times_$BASHPID
  times >"$file" # in this shell: another one would tell its own
  { read -r; read -r user system; } <"$file"
  processor=$(awk -F '[ms ]+' '{ printf "%d", $1 * 60 + $2 + $3 * 60 + $4 }' <<<"$user $system")
  rm "$file"
}

step() { # NAME COMMAND...
  local name=$1 started=$SECONDS code log result=passed count reason processor used
  shift
  count_processor_time
  used=$processor
  log=$notes/${part}_${name//[^a-zA-Z0-9]/_}.log
  printf '\n=== %s: %s\n' "$part" "$name"
  set +e
  (set -e; "$@") 2>&1 | tee "$log"
  code=${PIPESTATUS[0]}
  set -e
  if [ "$code" -ne 0 ]; then result=failed; fi
  step_code=$code
  count_processor_time
  used=$((processor - used))
  note "$name" "$result" $((SECONDS - started)) "$(counts "$log")" "$used"
  reasons "$log" | while IFS=$'\t' read -r count reason; do printf '%s\t%s\t%s\n' "$part" "$count" "$reason" >>"$notes/ignored"; done
  printf -- '--- %s: %s: %s, %s\n' "$part" "$name" "$result" "$(duration $((SECONDS - started)))"
}

must() { # NAME COMMAND...
  step "$@" # a condition would switch `set -e` off inside
  if [ "$step_code" -ne 0 ]; then finish; fi
}

call() { # PART COMMAND...
  local code=0
  "${@:2}" || code=$?
  if [ "$code" -ne 0 ] && ! has_failed "$1"; then part=$1 note "${*:2}" failed 0 "ended with status $code outside of a step"; fi
}

lack() { # NAME REASON
  if [ "${BABYBENCH_TESTS:-}" = required ]; then
    note "$1" failed 0 "required, but missing: $2"
  else
    note "$1" ignored 0 "$2"
  fi
  printf '\n=== %s: %s: ignored: %s\n' "$part" "$1" "$2"
}

summary() {
  local part name result seconds detail used
  echo '=== summary'
  while IFS=$'\t' read -r part name result seconds used detail; do
    if [ "$result" = ignored ]; then
      printf '%-7s %-34s ignored\n' "$part" "$name"
    else
      printf '%-7s %-34s %-7s %14s %6d s of CPU   %s\n' "$part" "$name" "$result" "$(duration "$seconds")" "$used" "$detail"
    fi
  done <"$notes/results"
  awk -F '\t' '$3 == "ignored" { printf "ignored: %s: %s: %s\n", $1, $2, $6 }' "$notes/results"
  # each reason once, with the number of tests
  awk -F '\t' '
    { reason = $1 ": " $3; if (!(reason in tests)) order[++n] = reason; tests[reason] += $2 }
    END { for (i = 1; i <= n; i++) { split(order[i], s, ": "); k = tests[order[i]]
      printf "ignored: %s: %d test%s: %s\n", s[1], k, k == 1 ? "" : "s", substr(order[i], length(s[1]) + 3) } }' "$notes/ignored"
  awk -F '\t' -v took="$(duration $((SECONDS - script_started)))" '
    $3 == "failed" { failed = failed sprintf("\n  %s: %s", $1, $2) }
    END { if (failed) printf "FAILED after %s:%s\n", took, failed; else printf "nothing failed; it took %s\n", took }' "$notes/results"
}

has_failed() { # [PART]: succeeds if a step failed, of this part or of any
  awk -F '\t' -v part="${1:-}" '$3 == "failed" && (part == "" || $1 == part) { found = 1 } END { exit !found }' "$notes/results"
}

finish() {
  if [ -n "$outermost" ]; then
    echo
    summary | tee "$notes/summary"
    part=''
  fi
  if has_failed "$part"; then exit 1; fi
  exit 0
}

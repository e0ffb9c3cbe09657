#!/usr/bin/env bash
# Prints the counts that tell how well the house is kept, of the files that git tracks as they stand: methods of Env, files that know one
# sense, the project's crates and those it depends on, features, hidden items, type names that are used twice, files that import each
# other in circles, lines and comments by room, and what is long. The same tree prints the same text.
#   scripts/house.sh
# scripts/house_table.py prints how the counts have changed since a commit.
# Needs Python 3, and cargo (for `cargo tree`; nothing is compiled), once the network for the index of crates.
set -euo pipefail
cd "$(dirname "$0")/.."
export LC_ALL=C

title() { echo; echo "## $1"; }
rust_files() { git ls-files -- "$@" | grep '\.rs$' | grep -v '/generated/'; }
methods_of() { # TYPE: its public methods in src, each name once
  git ls-files 'src/*.rs' | xargs awk -v of="$1" '
    $0 ~ "^impl(<[^>]*>)? (.* for )?" of "(<[^>]*>)? \\{" && $0 !~ / for / { within = 1; next }
    /^}/ { within = 0 }
    within && /^    pub (const )?fn / { name = $0; sub(/.*fn /, "", name); sub(/[^a-z0-9_].*/, "", name); print FILENAME ":" name }' | sort -u
}
required_of() { # TRAIT FILE: methods of a trait
  awk -v of="$1" '$0 ~ "^pub trait " of "[: ]" { within = 1; next } /^}/ { within = 0 } within && /^    fn / { n++ } END { print n + 0 }' "$2"
}
crates() { # FEATURES: of a normal build, the library itself among them
  cargo tree --locked --package babybench --edges normal --prefix none --no-dedupe "$@" | sed 's/ (.*//' | sort -u | wc -l
}

action_path() { # the files of an action's path, each with its functions in the order of calls
  cat <<'END'
src/env/mod.rs step check_action check_numbers mark
src/env/senses.rs begin_step
src/env/task/scene.rs play set_action advance steps
src/env/physics.rs check_shape parts note
src/env/task/mod.rs before_step
src/env/action_delay.rs pass
src/sensors/transform/delay.rs pass
src/actuation/spring_damper.rs set_action substep
src/spaces/mod.rs clip
src/env/engines.rs lend
src/model/pool.rs lend
src/env/paths.rs place
END
}

# Reads Rust files that rustfmt has laid out: a function ends at the first brace that stands as far right as its first line, and unit tests
# are what follows `#[cfg(test)]` before a module. Prints for each file: room, file, lines, code, docs, comments inside functions, other
# comments, tests; and for each function of the product: fn, lines, place, name.
read_rust() {
  awk '
    function close_file() {
      if (file != "") print "file", room, file, lines, code, docs, inside, beside, tests
    }
    FNR == 1 {
      close_file()
      file = FILENAME
      n = split(file, part, "/")
      room = part[1] != "src" ? part[1] : n == 2 ? "(files)" : part[2] ~ /\.rs$/ ? "(files)" : part[2]
      lines = code = docs = inside = beside = tests = 0
      within = testing = waiting = 0
      all_tests = part[1] == "src" && file ~ /tests(\.rs|\/)/
    }
    {
      lines++
      indent = match($0, /[^ ]/) - 1
      text = substr($0, indent + 1)
    }
    text == "" { next }
    text == "#[cfg(test)]" { waiting = 1; tests++; next }
    waiting { waiting = 0; if (text ~ /^(pub(\([a-z]*\))? )?mod .*\{$/) { testing = 1; margin = indent } tests++; next }
    testing { tests++; if (indent == margin && text ~ /^\}/) testing = 0; next }
    all_tests { tests++; next }
    text ~ /^\/\/[\/!]/ { docs++; next }
    text ~ /^\/\// { if (within) inside++; else beside++; next }
    { code++ }
    within && / \/\/ / && text !~ /"[^"]* \/\/ [^"]*"/ { inside++ }
    !within && text ~ /^(pub(\([a-z: ]*\))? )?(default )?(const )?(async )?(unsafe )?(extern "[A-Za-z]*" )?fn / {
      name = text
      sub(/^.*fn /, "", name)
      sub(/[^A-Za-z0-9_].*/, "", name)
      first = FNR
      edge = indent
      if (text ~ /\}$|;$/) { print "fn", 1, file ":" FNR, name; next }
      within = 1
      next
    }
    within && indent == edge && text ~ /^(\}|.*;$)/ { within = 0; print "fn", FNR - first + 1, file ":" first, name }
    END { close_file() }
  ' "$@"
}

by_room() { # adds the files of each room up
  printf '%-14s %6s %7s %7s %6s %8s %7s %6s %10s\n' room files lines code docs comments beside tests 'of 100'
  awk '
    $1 == "file" {
      r = $2
      files[r]++
      for (k = 4; k <= 9; k++) { sum[r, k] += $k; all[k] += $k }
      total++
    }
    function row(name, f, l, c, d, i, b, t) {
      printf "%-14s %6d %7d %7d %6d %8d %7d %6d %10.1f\n", name, f, l, c, d, i, b, t, c ? 100 * i / c : 0
    }
    END {
      for (r in files) row(r, files[r], sum[r, 4], sum[r, 5], sum[r, 6], sum[r, 7], sum[r, 8], sum[r, 9])
      row("all", total, all[4], all[5], all[6], all[7], all[8], all[9])
    }
  ' | sort -k3,3nr -k1,1
}

mapfile -t of_src < <(rust_files src)
mapfile -t of_others < <(rust_files cli conformance examples benches fuzz python testkit tests web)
src=$(read_rust "${of_src[@]}")
others=$(read_rust "${of_others[@]}")

echo '# The house in numbers'
title 'What a reader has to hold in the head'
methods=$(methods_of Env)
echo "public methods of Env: $(cut -d: -f2 <<<"$methods" | sort -u | wc -l), in $(cut -d: -f1 <<<"$methods" | sort -u | wc -l) files"
echo "public methods of TaskScene: $(methods_of TaskScene | wc -l)"
echo "methods of the trait Task: $(required_of Task src/env/task/mod.rs)"
echo "files that name the sense touch_pooled: $(git grep -l touch_pooled -- src python/src python/babybench_core web | wc -l)"
git grep -l touch_pooled -- src python/src python/babybench_core web | sed 's/^/  /'

title 'Files that an action passes: functions that run in Env::step before Engine::step, without those that only return a field'
action_path | while read -r file functions; do
  for name in $functions; do
    grep -qE "fn $name(<.*>)?\(" "$file" || { echo "house: $file has no function $name" >&2; exit 1; }
  done
  printf '  %-34s %s\n' "$file" "$functions"
done
echo "files: $(action_path | wc -l) (delay.rs only with a motor delay, paths.rs only with mocap_motion)"

title 'Crates of the library'
echo "without features: $(crates --no-default-features)"
echo "with the default features: $(crates)"
echo "with all features: $(crates --all-features)"

title 'Features and hidden items'
echo "features of babybench: $(awk '/^\[/ { within = $0 == "[features]" } within && / = / && $1 != "default" { print $1 }' Cargo.toml | sort | paste -sd' ')"
echo "items hidden from the documentation: $(git grep -hc 'doc(hidden)' -- 'src/*.rs' 'engine/*.rs' | awk '{ n += $1 } END { print n + 0 }')"
echo "conditions on features in src: $(git grep -hE 'cfg.*feature' -- 'src/*.rs' 'engine/*.rs' | wc -l)"

title 'Crates of this project that are published, with their lines of Rust'
for manifest in Cargo.toml cli/Cargo.toml engine/Cargo.toml src/model/Cargo.toml src/mjcf_loader/Cargo.toml src/physics/Cargo.toml \
  src/physics/rapier/Cargo.toml src/render/Cargo.toml; do
  folder=$(dirname "$manifest") name=$(sed -n 's/^name = "\(.*\)"$/\1/p' "$manifest" | head -n 1)
  case $name in
    babybench) files=$(git ls-files 'src/*.rs' | grep -vE '^src/(model|mjcf_loader|physics|render)/') ;;
    mjcf-sim-physics) files=$(git ls-files 'src/physics/*.rs' | grep -v '^src/physics/rapier/') ;;
    *) files=$(git ls-files "$folder/src/*.rs" "$folder/*.rs" | grep -v /tests/ | sort -u) ;;
  esac
  printf '%-18s %6d\n' "$name" "$(xargs cat <<<"$files" | wc -l)"
done

title 'Type names that are used more than twice in src'
git grep -hoE '^(pub(\([a-z: ]*\))? )?(struct|enum|trait|type) [A-Z][A-Za-z0-9]*' -- 'src/*.rs' 'engine/*.rs' | awk '{ print $NF }' | sort | uniq -c |
  awk '$1 > 2 { print $2, $1 }' | sort -k2,2nr -k1,1 | paste -sd, | sed 's/,/, /g'

title 'Files of one room that import each other in a circle (scripts/circles.py --imports prints the imports)'
circles=$(scripts/circles.py)
echo "circles: $(grep -c . <<<"$circles")"
while read -r circle; do echo "  $circle"; done <<<"$circles"

title 'Lines of src by room (comments: inside functions, also behind code; of 100: for every hundred lines of code)'
by_room <<<"$src"
title 'Lines of Rust beside it (tests count as code there)'
by_room <<<"$others"

title 'Functions of src with more than 60 lines'
awk '$1 == "fn" && $2 > 60 { print $2, $3, $4 }' <<<"$src" | sort -k1,1nr -k2,2
echo "of $(grep -c '^fn ' <<<"$src") functions; more than 40: $(awk '$1 == "fn" && $2 > 40' <<<"$src" | wc -l)"

title 'Files with more than 400 lines (Rust, Python, JavaScript)'
git ls-files -- '*.rs' '*.py' '*.js' '*.mjs' '*.ts' | grep -v '/generated/' | xargs wc -l | awk '$2 != "total" && $1 > 400 { print $1, $2 }' |
  sort -k1,1nr -k2,2

title 'Words'
echo "module docs that begin with What: $(rust_files . | xargs awk 'FNR == 1 && /^\/\/! What/' | wc -l)"
echo "summary lines that begin with What: $(rust_files . | xargs awk '/^ *\/\/\/ / && before !~ /^ *\/\/\// && /^ *\/\/\/ What/ { n++ } { before = $0 } END { print n + 0 }')"

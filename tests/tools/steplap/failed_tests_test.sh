#!/bin/sh
# tools/failed_tests on the logs of a run of ctest that is written here: what failed is shown and nothing else, never
# more than its share of the lines. Usage: failed_tests_test.sh path/to/tools/failed_tests
set -eu
program=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
logs=$folder/Testing/Temporary
mkdir -p "$logs"

section() { # number, name; what it wrote comes from standard input
  printf '%s/5 Testing: %s\n%s/5 Test: %s\nCommand: "test_%s"\nOutput:\n---------\n' "$1" "$2" "$1" "$2" "$2"
  cat
  printf '<end of output>\nTest time = 0.02 sec\n---------\nTest Failed.\n\n'
}
{
  echo 'Start testing: today'
  section 1 sound <<'END'
case.cpp:1: ERROR: of a test that passed, by design
END
  section 2 wrong <<'END'
a heading that is far from the error
case.cpp:7: ERROR: CHECK( a == b ) is NOT correct!
  values: CHECK( 1 == 2 )
END
  section 3 silent <<'END'
begun
the last line before it stopped
END
  { echo 'case.cpp:9: ERROR: the first of many'; seq -f 'case.cpp:9: ERROR: line %g' 1 500; } | section 4 chatty
} >"$logs/LastTest.log"
printf '2:wrong\n3:silent\n4:chatty\n5:absent\n' >"$logs/LastTestsFailed.log"

shown=$("$program" "$folder")
expect() { # there or not, text
  found=no
  case "$shown" in *"$2"*) found=yes ;; esac
  if [ "$found" != "$1" ]; then
    printf 'ERROR: expected "%s" to be shown: %s\n%s\n' "$2" "$1" "$shown"
    exit 1
  fi
}
expect yes '[wrong]'
expect yes 'case.cpp:7: ERROR: CHECK( a == b )'
expect yes 'values: CHECK( 1 == 2 )'
expect no 'a heading that is far'
expect yes 'the last line before it stopped'
expect yes 'the first of many'
expect yes 'more in'
expect no 'line 400'
expect no 'by design'
expect no 'Test time'
expect yes '[absent]
  did not run'
lines=$(printf '%s\n' "$shown" | wc -l)
[ "$lines" -le 90 ] || { echo "ERROR: $lines lines"; exit 1; }

# A run without failures has nothing to show, also where no tests have run.
: >"$logs/LastTestsFailed.log"
[ -z "$("$program" "$folder")" ] || { echo 'ERROR: something is shown of a run without failures'; exit 1; }
rm "$logs/LastTestsFailed.log"
[ -z "$("$program" "$folder")" ] || { echo 'ERROR: something is shown of a run without a list'; exit 1; }

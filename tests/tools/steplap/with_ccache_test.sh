#!/bin/sh
# with_ccache_test.sh LAUNCHER CCACHE COMPILER: a header is changed, changed back, and changed otherwise. The precompiled header is
# that of the last state, though ccache has seen the one before it be made from the same old one. Then a comment alone changes: the
# precompiled header that belongs to the old bytes must not be found again, or "#pragma once" lets the header be read twice.
set -eu
launcher=$1 ccache=$2 compiler=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export CCACHE_DIR="$folder/cache"
unset CCACHE_DISABLE CCACHE_NAMESPACE

echo "#include \"$folder/value.h\"" >all.hxx
echo '/* generated */' >all.hxx.cxx
echo 'int main() { return value; }' >main.cpp

# What ccache does not take to be changing just now.
change() {
  printf '#pragma once\ninline constexpr int value = %s;\n' "$1" >value.h
  touch -d "$2 days ago" value.h
}
precompile() {
  "$launcher" "$ccache" "$compiler" -std=c++20 -fpch-preprocess -x c++-header -MD -MF all.hxx.d -include "$folder/all.hxx" -o all.hxx.gch -c all.hxx.cxx
}
is_now() {
  "$compiler" -std=c++20 -Winvalid-pch -Werror -include "$folder/all.hxx" main.cpp -o main
  value=0
  ./main || value=$?
  [ "$value" -eq "$1" ] || { echo "with_ccache_test: the header says $1, the precompiled one $value" >&2; exit 1; }
}

change 1 9
precompile
is_now 1
cp -p all.hxx.gch first.gch
change 2 8
precompile
is_now 2
change 1 7
cp -p first.gch all.hxx.gch # as ccache gives it back
change 3 6
precompile
is_now 3

echo '#include "value.h"' >main.cpp # once more, by a source that includes what it uses
echo 'int main() { return value; }' >>main.cpp
is_now 3
printf '#pragma once\n// said\ninline constexpr int value = 3;\n' >value.h
touch -d '5 days ago' value.h
precompile
is_now 3
printf '#pragma once\n// else\ninline constexpr int value = 3;\n' >value.h
touch -d '4 days ago' value.h
precompile
is_now 3

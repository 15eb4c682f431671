#!/bin/bash
# SPDX-License-Identifier: MIT
# pages.sh MICROTIN: every help page has at most 80 columns, its options are in groups, values have names that say what
# they are, and each option that takes a value says whether it is required or what its default is. A page that breaks
# one of these rules does not pass.
set -eu
microtin=$1
source "$(dirname "$0")/help.sh"

faults() { # a page on standard input: its faults, one a line
  awk '
    function end_entry() {
      if (value != "" && entry !~ /\(([^()]*; )?(required|default: [^()]*[^() ])\)$/) print "no default: " entry
      value = ""
    }
    length($0) > 80 { print "too wide: " $0 }
    /^$/ || /^  [^ ]/ { end_entry() }
    /^[A-Z][^:]*:$/ { grouped = 1 }
    /^  -/ {
      if (!grouped) print "in no group: " $0
      entry = $0
      match($0, /^  (-[a-z], )?--[a-z-]+ ?/)
      value = substr($0, RLENGTH + 1)
      sub(/ .*/, "", value)
      if (value ~ /(TEXT|U?INT|FLOAT|NUMBER|STRING|VALUE)/ || value !~ /^([A-Za-z]+([,:|][A-Za-z]+)*(\.\.\.)?)?$/)
        print "bad name of a value: " $0
      next
    }
    /^   / { sub(/^ +/, " "); entry = entry $0 }
    END { end_entry() }'
}

check() { # COMMAND... FILTER: passes the pages through the filter
  local filter=$1
  "$microtin" --help | $filter | faults
  for command in $(commands); do "$microtin" "$command" --help | $filter | faults; done
}

found=$(check cat)
[ -z "$found" ] || { echo "$found"; exit 1; }
[ "$(commands | wc -l)" -gt 9 ]
for planted in 's/^Usage: .*/&, which is a line that is a little longer than any terminal is wide./' \
  's/METRES/FLOAT/' 's/N  /3TO9/' 's/; default: chosen)/)/' 's/; default: 1)/; default: )/' '/^[A-Z].*:$/d'; do
  filter=$(mktemp)
  printf '#!/bin/sed -f\n%s\n' "$planted" >"$filter"
  found=$(check "sed -f $filter")
  rm "$filter"
  [ -n "$found" ] || { echo "a planted fault was not found: $planted"; exit 1; }
done

#!/bin/bash
# SPDX-License-Identifier: MIT
# manual.sh MICROTIN: the manual page has every command and option, and no fault that groff or mandoc finds. Neither
# a page without an option nor one with an unknown macro passes.
set -eu
microtin=$1
source "$(dirname "$0")/help.sh"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

is_complete() { # PAGE
  for command in $(commands); do
    sed -n "/^\.SS $command\$/,/^\.S[HS] /p" "$1" | sed 's/\\-/-/g' >"$folder/chapter"
    for option in $(options "$command"); do
      [ "$option" = --help ] || grep -q "^\.B \(-[a-z], \)\{0,1\}$option\( \|\$\)" "$folder/chapter" ||
        { echo "$command: $option is missing"; return 1; }
    done
  done
}

is_sound() { # PAGE
  if command -v groff >/dev/null; then
    groff -man -ww -Tutf8 "$1" 2>&1 >/dev/null | grep . && return 1
  fi
  if command -v mandoc >/dev/null; then
    mandoc -T lint -W warning "$1" | grep -v 'missing date' | grep . && return 1
  fi
  return 0
}

"$microtin" manual >"$folder/microtin.1"
[ "$(commands | wc -l)" -gt 5 ]
is_complete "$folder/microtin.1"
is_sound "$folder/microtin.1"

grep -vF -- '\-\-z\-step' "$folder/microtin.1" >"$folder/planted.1"
! is_complete "$folder/planted.1" >/dev/null || { echo "a missing option was not found"; exit 1; }
if ! command -v groff >/dev/null && ! command -v mandoc >/dev/null; then
  echo "skipped in part: neither groff nor mandoc is installed"
  exit 77
fi
{ cat "$folder/microtin.1"; echo ".XX"; } >"$folder/planted.1"
! is_sound "$folder/planted.1" >/dev/null || { echo "an unknown macro was not found"; exit 1; }

#!/bin/bash
# SPDX-License-Identifier: MIT
# bash.sh MICROTIN: bash completes the commands, options and files of the help pages. A script that lacks an option
# does not pass.
set -eu
microtin=$1
source "$(dirname "$0")/help.sh"

compopt() { files=no; } # the one option that the script sets there

proposed() { # WORD...: what is proposed for the last word, and whether files may be
  COMP_WORDS=(microtin "$@") COMP_CWORD=$# files=yes
  _microtin
  echo "${COMPREPLY[*]} files=$files"
}

expect() { # PROPOSED WORD...
  local wanted=$1
  shift
  [ "$(proposed "$@")" = "$wanted" ] || { echo "microtin $*: $(proposed "$@"), not $wanted"; return 1; }
}

check() {
  expect "$(commands | tr '\n' ' ')-h --help --version files=no" "" || return 1
  for command in $(commands); do
    for option in $(options "$command"); do
      [[ " $(proposed "$command" --) " == *" $option "* ]] || { echo "$command: no $option"; return 1; }
    done
  done
  expect "encode files=no" enc &&
    expect "--max-error --max-vertices --max-bytes --max-degree files=yes" encode --max &&
    expect " files=no" encode --max-error "" &&
    expect " files=yes" encode t.asc -o "" &&
    expect " files=yes" encode "" &&
    expect " files=yes" encode --fast "" &&
    expect " files=yes" render --source "" &&
    expect " files=no" decode --cell "" &&
    expect "encode files=no" help enc
}

eval "$("$microtin" completion bash)"
check
eval "$("$microtin" completion bash | sed 's/--never-below//')"
! check >/dev/null || { echo "a missing option was not found"; exit 1; }

#!/bin/bash
# SPDX-License-Identifier: MIT
# zsh.sh MICROTIN: zsh reads its script, which has every command and option of --help.
set -eu
microtin=$1
source "$(dirname "$0")/help.sh"
script=$("$microtin" completion zsh)
for command in $(commands); do
  part=$(sed -n "/^    $command)\$/,/;;/p" <<<"$script")
  for option in $(options "$command"); do
    grep -qF -- ")$option[" <<<"$part" || { echo "$command: no $option"; exit 1; }
  done
done
grep -q "':command:(.* encode " <<<"$script" || grep -q "':command:(encode " <<<"$script" ||
  { echo "help: no commands"; exit 1; }
command -v zsh >/dev/null || { echo "skipped in part: zsh is not installed"; exit 77; }
zsh -n <<<"$script"
! zsh -n <<<"${script%\}*}" 2>/dev/null || { echo "a missing brace was not found"; exit 1; }

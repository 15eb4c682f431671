# SPDX-License-Identifier: MIT
# To be sourced, with the program in $microtin: what --help shows.

commands() { "$microtin" --help | sed -n 's/^  \([a-z]\{1,\}\) .*/\1/p'; }

options() { # COMMAND: its long options
  "$microtin" "$1" --help | sed -n 's/^  \(-[a-z], \)\{0,1\}\(--[a-z-]\{1,\}\).*/\2/p'
}

#!/bin/sh
# SPDX-License-Identifier: MIT
# prove.sh FILE...: what the lemmas of each file say of the source must follow, and not from assumptions that
# contradict each other. A lemma says which line of the source it is about; the line must be there:
#   ;; SOURCE: LINE
#   (push) (assert ASSUMPTION) ... (check-sat) (assert (not CONCLUSION)) (check-sat) (pop)
set -eu
cd "$(dirname "$0")/../.."
if ! command -v z3 >/dev/null; then
  echo "skipped: z3 is not installed"
  exit 77
fi
for file; do
  sed -n 's/^;; //p' "$file" | while IFS= read -r about; do
    grep -qF -- "${about#*: }" "${about%%: *}" || { echo "$file: gone from the source: $about" && exit 1; }
  done
  lemmas=$(grep -c '^(push)' "$file")
  answers=$(z3 -T:60 "$file")
  expected=$(for _ in $(seq "$lemmas"); do echo "sat unsat"; done)
  if [ "$(echo $answers)" != "$(echo $expected)" ] || [ "$(grep -c '^;; ' "$file")" -lt "$lemmas" ]; then
    echo "$file: not proved:" $answers
    exit 1
  fi
  echo "$file: $lemmas lemmas"
done

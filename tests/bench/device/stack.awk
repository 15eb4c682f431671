# objdump -d IMAGE | awk -v entries="f g" -f stack.awk: the most bytes of stack that a call of one of
# the functions takes, callees included. For Arm; fails where that cannot be told.

function fail(reason) {
  print "stack.awk: " reason > "/dev/stderr"
  failed = 1
  exit 1
}

# All that a function pushes is added up, even if no path pushes all of it.
function note_frame(code,  bytes) {
  if (code ~ /^(push|stmdb sp!)/) {
    frame[name] += 4 * split(code, registers, ",") - (code ~ /^stm/ ? 4 : 0)
  } else if (code ~ /^sub(w|\.w)? sp, (sp, )?#/ || code ~ /\[sp, #-[0-9]+\]!/) {
    bytes = code
    sub(/.*#-?/, "", bytes)
    frame[name] += bytes + 0
  } else if (code ~ /^(sub|mov)[^ ]* sp, / || code ~ /^vpush/) {
    trouble[name] = "a frame of unknown size: " code
  }
}

function note_call(code,  callee) {
  if (code ~ /^blx? r[0-9]/) trouble[name] = "an indirect call: " code
  if (code !~ /^b/ || !match(code, /<[^+>]*>/)) return
  callee = substr(code, RSTART + 1, RLENGTH - 2)
  if (callee != name || code ~ /^bl/) callees[name] = callees[name] " " callee
}

function depth(f,  i, count, list, below, d) {
  if (f in depths) return depths[f]
  if (!(f in functions)) fail("there is no function " f)
  if (f in trouble) fail(f ": " trouble[f])
  if (f in active) fail(f " calls itself")
  active[f] = 1
  count = split(callees[f], list, " ")
  for (i = 1; i <= count; ++i) if ((d = depth(list[i])) > below) below = d
  delete active[f]
  return depths[f] = frame[f] + below
}

/^[0-9a-f]+ <.*>:$/ {
  name = substr($2, 2, length($2) - 3)
  functions[name]
}

split($0, field, "\t") >= 3 {
  code = field[3] " " field[4]
  note_frame(code)
  note_call(code)
}

END {
  if (failed) exit 1
  count = split(entries, list, " ")
  for (i = 1; i <= count; ++i) if ((d = depth(list[i])) > most) most = d
  print most
}

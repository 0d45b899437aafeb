# worst_stack.awk -v root=PATTERN FILE.ci...: the most stack that a function can take, in bytes, with all that it calls.
#
# Reads what g++ -fcallgraph-info=su writes. To that it adds what GCC forgets: on Arm, a class that is passed by value
# partly in registers has those, up to 16 bytes, put on the stack by the function called. Refuses what has no bound or
# is not known: recursion, stack of a size that depends on data, calls through pointers, calls of functions that are
# neither in the files nor in `leaf_bytes`. The message says which; exit status 1.
BEGIN {
  # Of the C library: leaf functions, which push at most all sixteen registers.
  leaf_bytes["memcpy"] = leaf_bytes["memset"] = leaf_bytes["memmove"] = 64
  # The names by which Arm's run-time library has them.
  leaf_bytes["__aeabi_memcpy"] = leaf_bytes["__aeabi_memset"] = leaf_bytes["__aeabi_memclr"] = 64
}

# node: { title: "SYMBOL" label: "NAME\nPLACE\n48 bytes (static)" }; without bytes where the function is not in the
# file.
/^node:/ {
  symbol = quoted($0, "title: ")
  label = quoted($0, "label: ")
  name[symbol] = label
  sub(/\\n.*/, "", name[symbol])
  if (match(label, /[0-9]+ bytes \([a-z,]*\)/)) {
    usage = substr(label, RSTART, RLENGTH)
    bytes[symbol] = usage + 0 + split_argument(name[symbol])
    if (usage !~ /\(static\)/) varies[symbol] = 1
    if (name[symbol] ~ root) roots[symbol] = 1
  }
}
# Names begin with the file's path, which may have blanks: SUBSEP is in none.
/^edge:/ {
  caller = quoted($0, "sourcename: ")
  if (caller in calls) calls[caller] = calls[caller] SUBSEP quoted($0, "targetname: ")
  else calls[caller] = quoted($0, "targetname: ")
}

END {
  worst = -1
  for (symbol in roots) {
    deep = depth(symbol)
    if (deep > worst) worst = deep
  }
  if (worst < 0) refuse("no function matches " root)
  if (refused) exit 1
  print worst
}

function quoted(line, key,   from) {
  from = index(line, key "\"") + length(key) + 1
  line = substr(line, from)
  return substr(line, 1, index(line, "\"") - 1)
}

# 16 for a function that takes a class by value, as its declaration tells: a capitalised type that is not a reference.
function split_argument(declaration) {
  gsub(/(Real|Record|S)[,)]/, "", declaration)
  return declaration ~ /[A-Z][A-Za-z]*(<[^<>]*>)?[,)]/ ? 16 : 0
}

function depth(symbol,   callees, n, i, deep, most) {
  if (symbol in known) return known[symbol]
  if (symbol in on_path) return refuse("recursion: " name[symbol])
  if (!(symbol in bytes)) {
    if (symbol in leaf_bytes) return leaf_bytes[symbol]
    return refuse("unknown call: " (symbol in name && name[symbol] != "" ? name[symbol] : symbol))
  }
  if (symbol in varies) return refuse("stack of varying size: " name[symbol])
  on_path[symbol] = 1
  most = 0
  n = symbol in calls ? split(calls[symbol], callees, SUBSEP) : 0
  for (i = 1; i <= n; ++i) {
    deep = depth(callees[i])
    if (deep > most) most = deep
  }
  delete on_path[symbol]
  return known[symbol] = bytes[symbol] + most
}

function refuse(why) {
  print why > "/dev/stderr"
  refused = 1
  return 0
}

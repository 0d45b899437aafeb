# shellcheck shell=sh
# What tools/demo and tools/check share: installing what is missing, and running one part after the other with a log for
# each. Sourced by them, from the top of the checkout.

say() { printf '%s\n' "$*"; }

die() {
  printf '%s: %s\n' "${0##*/}" "$*" >&2
  exit 1
}

# shellcheck disable=SC2034  # for those who source this
jobs=$(nproc 2>/dev/null || getconf _NPROCESSORS_ONLN 2>/dev/null || echo 1)

# ---- installing what is missing --------------------------------------------------------------------------------------

has_command() { command -v "$1" >/dev/null 2>&1; }

# The Debian and Ubuntu package that brings what is missing: command:package, or file:package for a path that starts
# with /. Sets missing_packages.
find_missing() {
  missing_packages=
  for pair in "$@"; do
    what=${pair%%:*}
    package=${pair#*:}
    case $what in
      /*) [ -e "$what" ] && continue ;;
      *) has_command "$what" && continue ;;
    esac
    case "$missing_packages " in *" $package "*) continue ;; esac
    missing_packages="$missing_packages $package"
  done
}

# Sets as_root to the words that make a command run as root ("" for root itself); fails where there is no way to.
find_root() {
  if [ "$(id -u)" = 0 ]; then
    as_root=
  elif has_command sudo && sudo -n true 2>/dev/null; then
    as_root='sudo -n'
  elif has_command sudo && [ -t 0 ]; then
    as_root=sudo  # may ask for a password
  else
    return 1
  fi
}

# install_missing LOG command:package ...
install_missing() {
  install_log=$1
  shift
  find_missing "$@"
  [ -n "$missing_packages" ] || return 0
  has_command apt-get || die "missing:$missing_packages (Debian's names). There is no apt-get here: please install them and try again."
  find_root || die "missing:$missing_packages. Neither root nor sudo without a password: please run 'apt-get install$missing_packages' as root and try again."

  say "installing$missing_packages"
  # shellcheck disable=SC2086  # as_root and missing_packages are lists of words
  if ! {
    $as_root apt-get -o DPkg::Lock::Timeout=300 update ||
      say "apt-get update failed, perhaps for a source that is not needed: what can be installed will show"
    $as_root env DEBIAN_FRONTEND=noninteractive \
      apt-get -o DPkg::Lock::Timeout=300 install --yes --no-install-recommends $missing_packages
  } </dev/null >"$install_log" 2>&1; then
    tail -n 20 "$install_log" >&2
    die "apt-get could not install$missing_packages; all it said is in $install_log"
  fi
  find_missing "$@"
  [ -z "$missing_packages" ] || die "apt-get installed$missing_packages without bringing what was looked for; see $install_log"
}

require_cmake_3_22() {
  version=$(cmake --version | sed -n 's/^cmake version //p')
  case $version in
    [012].* | 3.[0-9].* | 3.1[0-9].* | 3.2[01].*) die "needs CMake 3.22 or newer, found $version (Debian 12 and Ubuntu 22.04 have it)" ;;
  esac
}

# Several builds compile the same sources with the same flags, and the next run most of them again: with ccache each
# once. Paths stay absolute: relative to a build folder they would differ between build/release and the builds of tests,
# which lie deeper.
use_compiler_cache() {
  has_command ccache || return 0
  export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
  CCACHE_NOHASHDIR=1                        # nor does it matter from which folder the compiler is called
  CCACHE_SLOPPINESS=pch_defines,time_macros  # else it leaves out what includes a precompiled header
  export CCACHE_NOHASHDIR CCACHE_SLOPPINESS
  unset CCACHE_BASEDIR
}

# Ninja calls the compiler from the top of the build folder wherever a source lies: then builds of other projects find
# in the compiler cache what this one's left there. A build folder that exists keeps its generator.
use_ninja() {
  if has_command ninja; then export CMAKE_GENERATOR=Ninja; fi
}

# ---- one part after the other ----------------------------------------------------------------------------------------

# run_logged LOG command...: quiet; when the command fails, the end of what it printed goes to stderr.
run_logged() {
  log=$1
  shift
  if "$@" </dev/null >"$log" 2>&1; then
    return 0
  fi
  {
    say "---- $* failed; the end of $log:"
    tail -n 60 "$log"
    say "----"
  } >&2
  return 1
}

# run_watched LOG command...: as run_logged, of a build by CMake; every ten seconds, or watch_every_s, a line tells how
# far it is.
run_watched() {
  while sleep "${watch_every_s:-10}" >/dev/null 2>&1 && kill -0 "$$" 2>/dev/null; do
    sed -n 's/^\(\[[ 0-9%/]*\]\).*/  \1/p' "$1" | tail -n 1
  done &
  watcher=$!
  status=0
  run_logged "$@" || status=$?
  kill "$watcher" 2>/dev/null || :
  return $status
}

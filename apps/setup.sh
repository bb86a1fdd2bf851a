# Sets up koppel on Debian 12: packages, configuration, build. Sourced by apps/try and tests/run, never run by itself.
# Whoever sources it gets `root` (the top folder) and the functions below. What the tools print goes into a log in the
# build folder; on the terminal there is one line for each step.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
export LC_ALL=C.UTF-8

# What the programs need, what the tests need besides, and what the checks of format and lint need besides.
packages_build="g++ cmake ninja-build ccache libeigen3-dev libceres-dev libspdlog-dev liblcm-dev liblcm-bin
  libtomlplusplus-dev libcli11-dev libexpected-dev libmuparser-dev libsundials-dev nlohmann-json3-dev graphviz"
packages_test="libgtest-dev libgmock-dev libbenchmark-dev python3 python3-numpy python3-mpmath liblcm-java
  libjchart2d-java openjdk-17-jre openjdk-17-jdk-headless xvfb xauth iproute2"
packages_lint="clang-format clang-tidy"

fail() {
  echo "koppel: $*" >&2
  exit 1
}

# logged LOG TEXT COMMAND...: runs the command with its output in the log; shows the end of it if the command fails.
logged() {
  local log=$1 text=$2 begin=$SECONDS
  shift 2
  mkdir -p "$(dirname "$log")"
  printf '%s ... ' "$text"
  echo "== $*" >>"$log"
  if "$@" >>"$log" 2>&1; then
    echo "done ($((SECONDS - begin)) s)"
  else
    echo "failed"
    tail -n 40 "$log" >&2
    fail "$text failed; everything that was printed stands in $log"
  fi
}

# missing PACKAGE...: those that are not installed. Asks dpkg only: no network, a few milliseconds.
missing() {
  local installed package
  # dpkg-query fails where it does not know a package at all: that one is missing, too.
  installed=" $(dpkg-query -W -f='${db:Status-Status}:${Package} ' "$@" 2>/dev/null || true) "
  for package in "$@"; do
    [[ $installed == *" installed:$package "* ]] || echo "$package"
  done
}

install_packages() {
  # A list that cannot be refreshed may still serve.
  apt-get update || true
  DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "$@"
}

# need PACKAGE...: installs what is missing.
need() {
  command -v dpkg-query >/dev/null ||
    fail "this is not Debian: install by hand what corresponds to: $*; then use cmake --preset release"
  local lacking
  mapfile -t lacking < <(missing "$@")
  ((${#lacking[@]})) || return 0
  ((EUID == 0)) || fail "packages are missing. As root: apt-get update && apt-get install -y ${lacking[*]}"
  logged "$root/build/setup.log" "installing ${#lacking[@]} packages" install_packages "${lacking[@]}"
}

# build PRESET FOLDER "CONFIGURE OPTIONS" TARGET...: configures and builds; ninja does only what is left to do.
build() {
  local preset=$1 folder=$root/$2 options=$3
  shift 3
  local log=$folder/setup.log
  cd "$root" || exit 1
  # Debian's Python has Debian's numpy, whatever other Python comes first in PATH.
  # shellcheck disable=SC2086  # options are words
  logged "$log" "configuring $preset" cmake --preset "$preset" -DPython3_EXECUTABLE=/usr/bin/python3 $options
  logged "$log" "building $preset" cmake --build "$folder" --target "$@"
}

# shellcheck shell=bash
# Shared by packaging/quickstart and packaging/test; sourced, not run.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build  # of the preset release
log=$(mktemp)
trap 'rm -f "$log"' EXIT

say() { printf '== %s\n' "$*"; }

die() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# quietly COMMAND...: its output is shown only when it fails.
quietly() {
  local status=0
  "$@" </dev/null >"$log" 2>&1 || status=$?
  ((status == 0)) || tail -n 40 "$log" >&2
  return "$status"
}

# install_packages GROUP...: installs what is missing of these groups of packages.txt.
install_packages() {
  local group name missing=()
  command -v dpkg-query >/dev/null ||
    die "it installs Debian packages; elsewhere, install what packaging/packages.txt lists and build by hand"
  while read -r group name _; do
    [[ " $* " == *" $group "* ]] || continue
    [[ $(dpkg-query -W -f='${db:Status-Status}' "$name" 2>/dev/null) == installed ]] ||
      missing+=("$name")
  done <"$root/packaging/packages.txt"
  if ((${#missing[@]} == 0)); then
    say "packages: all installed"
    return
  fi
  say "packages: installing ${missing[*]}"
  local as_root=()
  if ((EUID != 0)); then
    command -v sudo >/dev/null || die "needs root or sudo for: apt-get install ${missing[*]}"
    as_root=(sudo)
  fi
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y
    -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3)
  local install=("${apt[@]}" install --no-install-recommends "${missing[@]}")
  # A usable package list saves the slow step; without one, or with a stale one, it is fetched.
  if compgen -G '/var/lib/apt/lists/*Packages*' >/dev/null &&
    "${install[@]}" </dev/null >"$log" 2>&1; then
    return
  fi
  quietly "${apt[@]}" update || die "apt-get update failed"
  quietly "${install[@]}" || die "apt-get install failed"
}

# Compilers at once: one a core, but 1.5 GB of free memory each (VTK and OCCT headers are heavy).
parallel_jobs() {
  local cores memory_kb jobs
  cores=$(nproc)
  memory_kb=$(awk '/^MemAvailable:/ {print $2}' /proc/meminfo)
  jobs=$((memory_kb / 1572864))
  ((jobs <= cores)) || jobs=$cores
  ((jobs >= 1)) || jobs=1
  echo "$jobs"
}

# build_targets TARGET...: configures build/ and builds; everything without an argument.
# Our own code is compiled with warnings as errors (lamella_flags in CMakeLists.txt).
build_targets() {
  local jobs wanted=()
  jobs=$(parallel_jobs)
  cd "$root" || die "no folder $root"
  say "configure: build/, preset release"
  quietly cmake --preset release || die "cmake failed"
  say "build: ${*:-everything}, $jobs job(s)"
  (($# == 0)) || wanted=(--target "$@")
  cmake --build --preset release --parallel "$jobs" "${wanted[@]}" </dev/null
}

# with_display COMMAND...: on the display there is, or on a virtual one.
with_display() {
  if [[ -n ${DISPLAY:-}${WAYLAND_DISPLAY:-} ]]; then
    "$@"
  else
    LIBGL_ALWAYS_SOFTWARE=1 QT_QPA_PLATFORM=xcb \
      xvfb-run -a -s "-screen 0 1600x1000x24 +extension GLX" "$@"
  fi
}

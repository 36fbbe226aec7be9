# Sourced by run.sh here and by tests/run.sh, with `top` the top folder of the checkout: what a bare Debian 12 machine
# needs to build and run nsma. Nothing is done when nothing is missing.

# Compiler and build tools; libraries, each for its own field; tests; charts and a font to write on them.
packages="
g++ cmake ninja-build pkg-config
libeigen3-dev coinor-libipopt-dev libnlopt-dev libnlopt-cxx-dev coinor-libclp-dev coinor-libcoinutils-dev
libboost-dev libtomlplusplus-dev libcli11-dev nlohmann-json3-dev libfmt-dev
libsqlitecpp-dev libsqlite3-dev libopenmpi-dev openmpi-bin
libgtest-dev libgmock-dev strace
gnuplot-nox fonts-dejavu-core
"

say() {
    printf '== %s\n' "$*"
}

# Any gnuplot will do: the flavours exclude each other, so one that is there is left alone.
is_installed() {
    if [ "$1" = gnuplot-nox ] && command -v gnuplot >/dev/null; then
        return 0
    fi
    dpkg-query -W -f '${db:Status-Status}\n' "$1" 2>/dev/null | grep -q '^installed$'
}

install_packages() {
    if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
        say "not a Debian machine, nothing installed; needed are the equivalents of:$packages"
        return 0
    fi
    missing=""
    for package in $packages; do
        is_installed "$package" || missing="$missing $package"
    done
    if [ -z "$missing" ]; then
        say "all packages are there"
        return 0
    fi
    if [ "$(id -u)" -eq 0 ]; then
        sudo=""
    elif command -v sudo >/dev/null; then
        sudo=sudo
    else
        say "neither root nor sudo here; as root, run: apt-get install --no-install-recommends$missing" >&2
        exit 1
    fi
    say "installing$missing"
    apt="$sudo env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=300"
    $apt update
    # shellcheck disable=SC2086  # one word a package
    $apt install -y --no-install-recommends $missing
}

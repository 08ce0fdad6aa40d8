# SPDX-License-Identifier: MIT
# shellcheck shell=bash
# Shared by run.sh and test.sh: the Debian packages, the build, the device, and messages of what went wrong.

packages=(meson ninja-build python3 pkg-config gcc g++ libvulkan-dev glslang-tools spirv-tools
    mesa-vulkan-drivers vulkan-validationlayers libglfw3-dev libtinygltf-dev libstb-dev libpng-dev
    libcglm-dev libopenexr-dev libembree-dev libcmocka-dev libspirv-cross-c-shared-dev spirv-cross libcjson-dev
    libimgui-dev libx11-dev zlib1g-dev libdraco-dev libmeshoptimizer-dev libwebp-dev gnuplot-nox xvfb xauth cmake)

# What tests/fuzz/run.sh needs besides.
fuzz_packages=(clang libclang-rt-dev)

say() {
    printf '%s\n' "== $*" >&2
}

die() {
    printf '%s: %s\n' "$(basename "$0")" "$*" >&2
    exit 1
}

# Names of the packages that are not installed, one per line.
missing_packages() {
    local package status
    for package in "${packages[@]}"; do
        status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
        [ "$status" = installed ] || printf '%s\n' "$package"
    done
}

install_packages() {
    command -v dpkg-query >/dev/null ||
        die "this needs Debian 12 or a relative of it; the packages are listed in scripts/packages.sh"
    local missing
    mapfile -t missing < <(missing_packages)
    [ "${#missing[@]}" -gt 0 ] || return 0
    local as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || die "not root and no sudo: install ${missing[*]}"
        as_root=(sudo)
    fi
    say "installing ${missing[*]}"
    "${as_root[@]}" apt-get -qq update || die "apt-get update failed"
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq install --no-install-recommends -y \
        "${missing[@]}" >/dev/null || die "apt-get could not install ${missing[*]}"
}

# configure_and_build FOLDER [TARGET] [meson options]: safe to call again and after an interruption.
configure_and_build() {
    local folder=$1 target=all
    shift
    if [ $# -gt 0 ] && [[ $1 != -* ]]; then
        target=$1
        shift
    fi
    if [ -f "$folder/build.ninja" ]; then
        meson configure "$folder" "$@" >/dev/null || die "meson could not change the options of $folder"
    else
        say "configuring $folder"
        mkdir -p "$folder"
        meson setup "$folder" "$@" >"$folder/setup.log" 2>&1 || {
            tail -n 20 "$folder/setup.log" >&2
            die "meson setup failed; all of it is in $folder/setup.log"
        }
    fi
    say "building"
    ninja -C "$folder" --quiet "$target" || die "the build failed"
    # The program is promised as $folder/sdfgi; meson puts it into the folder of its sources.
    if [ -x "$folder/runtime/sdfgi" ]; then
        ln -sfn runtime/sdfgi "$folder/sdfgi"
    fi
}

# The programs of libFuzzer, in a folder of their own: all code is compiled with clang and sanitizers.
build_fuzzers() {
    export CC=clang CXX=clang++
    configure_and_build "$1" fuzz -Dfuzz=enabled -Dwindow=disabled -Dbuildtype=debugoptimized \
        -Db_ndebug=false -Db_lundef=false
}

# best_device PROGRAM: the GPU that it renders with if no other is asked for, as "NAME (TYPE)"; none: nothing.
best_device() {
    "$1" info 2>/dev/null | awk '
        /^device [0-9]+: / { name = $0; sub(/^device [0-9]+: /, "", name) }
        /^  type / { type = $2 }
        /^  program +usable/ && rank[type] > best { best = rank[type]; found = name " (" type ")" }
        BEGIN { rank["discrete"] = 3; rank["integrated"] = 2; rank["virtual"] = 1 }
        END { print found }' || true
}

# choose_device PROGRAM: drivers that were chosen, else the machine's own GPU, else lavapipe. Says which.
choose_device() {
    local gpu
    if [ -n "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ]; then
        say "rendering with the driver of ${VK_DRIVER_FILES:-$VK_ICD_FILENAMES}"
        return 0
    fi
    gpu=$(best_device "$1")
    if [ -n "$gpu" ]; then
        say "rendering on $gpu"
        return 0
    fi
    choose_lavapipe
    say "rendering on the CPU with lavapipe: there is no GPU that will do, see $1 info"
}

# Unless a driver was chosen, lavapipe: it is everywhere and gives the same picture everywhere.
choose_lavapipe() {
    [ -z "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ] || return 0
    local file
    for file in /usr/share/vulkan/icd.d/lvp_icd*.json /etc/vulkan/icd.d/lvp_icd*.json; do
        if [ -f "$file" ]; then
            export VK_DRIVER_FILES=$file VK_ICD_FILENAMES=$file
            return 0
        fi
    done
    die "no lavapipe driver found; install mesa-vulkan-drivers or set VK_DRIVER_FILES"
}

# Reads the options of a script that measures: --build goes to `build`, the others to `measure`. Builds into
# build/ unless a build is named.
#   measuring_options "--flag ..." "--option ..." ARGUMENT...
measuring_options() {
    local flags=" $1 " options=" $2 --build "
    shift 2
    build=
    measure=()
    while [ $# -gt 0 ]; do
        if [[ $flags == *" $1 "* ]]; then
            measure+=("$1")
            shift
            continue
        fi
        [[ $options == *" $1 "* ]] || die "unknown option $1; see --help"
        [ $# -ge 2 ] || die "$1 needs a value; see --help"
        if [ "$1" = --build ]; then build=$2; else measure+=("$1" "$2"); fi
        shift 2
    done
    if [ -z "$build" ]; then
        build=build
        install_packages
        configure_and_build "$build"
    fi
}

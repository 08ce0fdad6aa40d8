#!/bin/sh
# SPDX-License-Identifier: MIT
# An installed copy is enough to build and run a host: installs the build into an empty folder, compiles the
# smallest host and its shader there with nothing but pkg-config's flags, runs it, and looks at the picture that it
# wrote.
#
# usage: install_test.sh BUILD_DIR HOST_SOURCE PICTURE_COLORS [CC...]
set -eu

build=$(realpath "$1") host=$(realpath "$2") picture_colors=$(realpath "$3")
shift 3
[ $# -gt 0 ] || set -- cc

fail() {
    echo "install_test: $*" >&2
    exit 1
}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/host" "$work/pkgconfig"

DESTDIR=$work/root meson install -C "$build" --no-rebuild --quiet || fail "meson install failed"

# The copy lies under a staging folder, where its own paths do not point: move the prefix there.
installed=$(find "$work/root" -name sdfgi.pc)
[ -n "$installed" ] || fail "no sdfgi.pc was installed"
sed "s|^prefix=|prefix=$work/root|" "$installed" >"$work/pkgconfig/sdfgi.pc"
export PKG_CONFIG_PATH="$work/pkgconfig"

[ -n "$(find "$work/root" -path '*/sdfgi/sdfgi.h')" ] || fail "sdfgi/sdfgi.h was not installed"
[ -n "$(find "$work/root" -name sdfgi.glsl)" ] || fail "sdfgi.glsl was not installed"

# Outside the tree, so that nothing in it can help.
name=$(basename "$host" .c)
cp "$host" "${host%.c}.comp" "$work/host/" || fail "a host is a .c with a .comp beside it"
cd "$work/host"
shaders=$(pkg-config --variable=shaderdir sdfgi)
[ -f "$shaders/sdfgi.glsl" ] || fail "pkg-config's shaderdir does not hold sdfgi.glsl"
glslangValidator -V --quiet --target-env vulkan1.2 "-I$shaders" --vn shade \
    -o "${name}_spirv.h" "$name.comp" ||
    fail "the host's shader does not compile"
flags=$(pkg-config --cflags --libs sdfgi vulkan) || fail "pkg-config does not know sdfgi"
# shellcheck disable=SC2086 # the flags are words
"$@" -std=c11 -Wall -Wextra -Wpedantic -I. -o host "$name.c" $flags -lm || fail "the host does not compile"

library=$(pkg-config --variable=libdir sdfgi)
LD_LIBRARY_PATH=$library ./host picture.ppm || fail "the host ended with $?"

picture=$(find . -name '*.ppm' -o -name '*.png' -o -name '*.hdr' | head -n 1)
[ -n "$picture" ] || fail "the host wrote no picture"
"$picture_colors" "$picture" || fail "the picture shows a single colour"

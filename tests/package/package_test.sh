#!/bin/sh
# SPDX-License-Identifier: MIT
# The library alone is built with the one command of docs/packaging.md, where nothing is to be found but the
# headers of Vulkan; it exports what its headers say, and nothing else; hosts in C and C++ build and run against
# an installed copy that was moved, through pkg-config and CMake, with the shared and the static library; and
# sample hosts draw pictures.
#
# usage: package_test.sh SOURCE VERSION PICTURE_COLORS COMPILED
# COMPILED is a folder of headers that the library's shaders were compiled to by the same commands.
set -eu

source=$(realpath "$1") version=$2 picture_colors=$(realpath "$3") compiled=$(realpath "$4")
CC=${CC:-cc} CXX=${CXX:-c++}
strict="-Wall -Wextra -Werror -pedantic-errors"

fail() {
    echo "package_test: $*" >&2
    exit 1
}

# quietly WHAT COMMAND...: the output is worth seeing if it fails.
quietly() {
    what=$1
    shift
    "$@" >"$work/log" 2>&1 || {
        tail -n 30 "$work/log" >&2
        fail "$what failed"
    }
}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/only" "$work/host" "$work/bin"

# A compiler of shaders for the library's build: what the tree's own build has made is not made again.
real_glslang=$(command -v glslangValidator) || fail "no glslangValidator"
cat >"$work/bin/glslangValidator" <<SCRIPT
#!/bin/sh
for last; do
    [ "\${before-}" != -o ] || output=\$last
    before=\$last
done
made=$compiled/\${output##*/}
[ -n "\${output-}" ] && [ -f "\$made" ] && [ "\$made" -nt "\$last" ] && exec cp "\$made" "\$output"
exec "$real_glslang" "\$@"
SCRIPT
chmod +x "$work/bin/glslangValidator"

# ---- Build and install

cp "$(pkg-config --variable=pcfiledir vulkan)/vulkan.pc" "$work/only/"
quietly "meson setup" env PKG_CONFIG_LIBDIR="$work/only" CXX=false PATH="$work/bin:$PATH" \
    meson setup "$work/build" "$source" -Dauto_features=disabled -Ddefault_library=both -Dbuildtype=plain \
    --prefix="$work/first"
quietly "building" ninja -C "$work/build" -j2
quietly "meson install" meson install -C "$work/build" --no-rebuild
rm -rf "$work/build"

# What was found by its own place still is after a move.
mv "$work/first" "$work/prefix"
prefix=$work/prefix
pc=$(find "$prefix" -name sdfgi.pc)
[ -n "$pc" ] || fail "no sdfgi.pc was installed"
PKG_CONFIG_PATH=$(dirname "$pc")
export PKG_CONFIG_PATH
libdir=$(realpath "$(pkg-config --variable=libdir sdfgi)")
shaders=$(realpath "$(pkg-config --variable=shaderdir sdfgi)")
[ "$(pkg-config --modversion sdfgi)" = "$version" ] || fail "sdfgi.pc is not of version $version"
[ -f "$shaders/sdfgi.glsl" ] || fail "pkg-config's shaderdir does not hold sdfgi.glsl"

# ---- Symbols

grep -hA2 "^SDFGI_API" "$prefix"/include/sdfgi/*.h | grep -oE "sdfgi_[a-z0-9_]+\(" | tr -d '(' |
    sort -u >"$work/promised"
nm -D --defined-only "$libdir/libsdfgi.so" | awk '{ print $3 }' | sort -u >"$work/exported"
[ -s "$work/promised" ] || fail "no header declares a function"
diff "$work/promised" "$work/exported" || fail "< is declared alone, > is exported alone"
others=$(nm -g --defined-only "$libdir/libsdfgi.a" | awk 'NF == 3 && $3 !~ /^sdfgi_/ { print $3 }')
[ -z "$others" ] || fail "global names in the static library that a host may have, too: $others"

# ---- Hosts

cp "$source/tests/package/host.c" "$work/host/host.c"
cp "$work/host/host.c" "$work/host/host.cpp"
cp "$source/tests/package/CMakeLists.txt" "$source/samples/minimal_host.c" "$source/samples/minimal_host.comp" \
    "$work/host/"
cd "$work/host"
# A small volume shows as many colours, and takes a seventh of the time; SDFGI_TEST_FULL=1 has the sample's own.
if [ "${SDFGI_TEST_FULL-}" != 1 ]; then
    sed -i 's/settings.cascades = 2,/settings.cascades = 1, settings.resolution = 32,/' minimal_host.c
    grep -q 'settings.resolution = 32' minimal_host.c || fail "minimal_host.c has other settings than expected"
fi

# check_host KIND PROGRAM: it runs, says its version, and needs the shared library or does not.
check_host() {
    said=$(LD_LIBRARY_PATH=$libdir "$2") || fail "$2 ended with $?"
    [ "$said" = "$version" ] || fail "$2 is of version $said, not $version"
    needed=$(readelf -d "$2" | grep -c "NEEDED.*libsdfgi" || true)
    case $1 in
    shared) [ "$needed" = 1 ] || fail "$2 does not need the shared library" ;;
    static) [ "$needed" = 0 ] || fail "$2 needs the shared library" ;;
    esac
}

# Where both libraries are installed, linkers take the shared one unless told otherwise.
cflags=$(pkg-config --cflags sdfgi)
shared=$(pkg-config --libs sdfgi)
static=$(pkg-config --static --libs sdfgi | sed 's/-lsdfgi/-Wl,-Bstatic -lsdfgi -Wl,-Bdynamic/')
case $shared in *vulkan*) fail "hosts are made to link the loader: $shared" ;; esac
for kind in shared static; do
    eval "libs=\$$kind"
    # shellcheck disable=SC2086 # flags are words
    {
        quietly "$kind host in C" $CC -std=c11 $strict $cflags -o "${kind}_c" host.c $libs
        quietly "$kind host in C++" $CXX -std=c++17 $strict $cflags -o "${kind}_cpp" host.cpp $libs
    }
    check_host $kind "./${kind}_c"
    check_host $kind "./${kind}_cpp"
done

if command -v cmake >/dev/null; then
    next_minor=$(echo "$version" | awk -F. '{ print $1 "." $2 + 1 }')
    for kind in shared static; do
        loader=BEFORE
        [ $kind = shared ] || loader=AFTER
        quietly "cmake for the $kind library" cmake -S . -B "$kind" -DCMAKE_PREFIX_PATH="$prefix" -DKIND=$kind \
            -DLOADER=$loader -DVERSION="${version%.*}" -DNEXT_MINOR="$next_minor" \
            -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF
        quietly "$kind hosts with CMake" cmake --build "$kind" -j2
        check_host $kind "$kind/host_c"
        check_host $kind "$kind/host_cpp"
        [ "$(realpath "$(cat "$kind/shader_dir")")" = "$shaders" ] ||
            fail "sdfgi_SHADER_DIR is $(cat "$kind/shader_dir")"
    done
else
    echo "package_test: no cmake here: find_package was not tried"
fi

# ---- A picture

quietly "the smallest host's shader" glslangValidator -V --quiet --target-env vulkan1.2 "-I$shaders" --vn shade \
    -o minimal_host_spirv.h minimal_host.comp
# shellcheck disable=SC2086 # flags are words
quietly "the smallest host" $CC -std=c11 -Wall -Wextra -Wpedantic -I. -o minimal_host minimal_host.c \
    $(pkg-config --cflags --libs sdfgi vulkan)
quietly "the smallest host's picture" env LD_LIBRARY_PATH="$libdir" ./minimal_host picture.ppm
"$picture_colors" picture.ppm || fail "the picture shows a single colour"

# Hosts with a renderer, in a folder that holds samples alone.
if ls /usr/include/cglm/cglm.h >/dev/null 2>&1; then
    mkdir samples
    cp "$source"/samples/sample_* "$source"/samples/forward_host.* "$source"/samples/deferred_* samples/
    cd samples
    for shader in *.vert *.frag *.comp; do
        name=$(echo "$shader" | tr . _)
        quietly "$shader" glslangValidator -V --quiet --target-env vulkan1.2 "-I$shaders" --vn "$name" \
            -o "${name%_*}_spirv.h" "$shader"
    done
    # shellcheck disable=SC2086 # flags are words
    {
        vulkan=$(pkg-config --cflags --libs vulkan)
        quietly "what sample hosts share" $CC -std=c11 -Wall -Wextra -Werror -c sample_*.c $cflags
        quietly "the deferred host" $CC -std=c11 -Wall -Wextra -Werror $cflags -o deferred deferred_host.c \
            sample_*.o $shared $vulkan -lm
        quietly "the forward host" $CXX -std=c++17 -Wall -Wextra -Werror $cflags \
            -o forward forward_host.cpp sample_*.o $shared $vulkan -lm
    }
    for host in forward deferred; do
        quietly "the $host host's picture" env LD_LIBRARY_PATH="$libdir" ./$host --size 72x48 --gi off \
            --out $host.ppm
        "$picture_colors" $host.ppm || fail "the picture of the $host host shows a single colour"
    done
else
    echo "package_test: no cglm here: hosts with a renderer were not tried"
fi

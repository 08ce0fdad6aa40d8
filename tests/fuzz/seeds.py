#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the seeds: seeds.py OUT makes OUT/TARGET/NAME. Readers must take files named valid_*, must refuse
those named broken_*, and may do as they like with the others; each must be over in a second. The target first
puts the checksums right where the name says _mended. A file that was a finding is named after what it did."""
import base64
import json
import pathlib
import struct
import sys
import zlib

files = {}


def add(target, name, data):
    files[f"{target}/{name}"] = data.encode() if isinstance(data, str) else bytes(data)


# ---- PNG ------------------------------------------------------------------------------------------------

def png_chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(width, height, depth, color, rows, *more, interlace=0):
    head = struct.pack(">IIBBBBB", width, height, depth, color, 0, 0, interlace)
    return b"".join([b"\x89PNG\r\n\x1a\n", png_chunk(b"IHDR", head), *[png_chunk(*m) for m in more],
                     png_chunk(b"IDAT", zlib.compress(rows, 9)), png_chunk(b"IEND", b"")])


def png_seeds():
    add("png", "valid_rgba8", png(2, 2, 8, 6, b"\0" + bytes(range(8)) + b"\1" + bytes(range(8))))
    add("png", "valid_rgb16", png(1, 2, 16, 2, b"\0" + bytes(6) + b"\2" + bytes(range(6))))
    add("png", "valid_grey1", png(9, 2, 1, 0, b"\0\xaa\x80\0\x55\0"))
    add("png", "valid_grey_alpha", png(2, 1, 8, 4, b"\4" + bytes(range(4))))
    add("png", "valid_palette_with_alpha",
        png(3, 1, 2, 3, b"\0\x18", (b"PLTE", bytes(range(9))), (b"tRNS", b"\x80\xff")))
    add("png", "valid_interlaced", png(3, 3, 8, 0, b"\3\1" + b"\0\2" * 2 + b"\0\1\2" + b"\0\4" * 2 + b"\0abc",
                                       interlace=1))
    add("png", "valid_text_and_gamma", png(1, 1, 8, 0, b"\0\7", (b"gAMA", b"\0\0\xb1\x8f"),
                                           (b"tEXt", b"a\0b"), (b"zTXt", b"a\0\0" + zlib.compress(b"text"))))
    add("png", "more_rows_than_pixels_took_gigabytes", png(1, 1, 8, 6, bytes(4_000_000)))
    add("png", "broken_claims_32768_squared", png(32768, 32768, 8, 6, b""))
    # Readers that guess the format by the first bytes took these for pictures of other formats.
    add("png", "broken_targa_of_26224_x_365", struct.pack("<BBBHHBHHHHBB", 0, 0, 2, 0, 0, 0, 0, 0, 26224, 365,
                                                       24, 0) + bytes(9))
    add("png", "broken_is_a_jpeg", jpeg())


# ---- JPEG -----------------------------------------------------------------------------------------------

def jpeg_segment(marker, data):
    return bytes([0xff, marker]) + struct.pack(">H", len(data) + 2) + data


def jpeg(components=1, frame=0xc0, sampling=0x11, dc=b"\0\0", codes=None, restart=0, tables=2):
    """A table with one code of one bit for each kind: all blocks are grey."""
    ids, rest = range(1, components + 1), (b"\0\0\0" if frame == 0xc2 else b"\0\x3f\0")
    head = struct.pack(">BHHB", 8, 8, 8, components)
    table = bytes([0, 1] + [0] * 15) if codes is None else bytes([0]) + bytes(codes)
    table += bytes(sum(table[1:]))
    huffman = [jpeg_segment(0xc4, table), jpeg_segment(0xc4, b"\x10" + table[1:])][:tables]
    return b"".join([
        b"\xff\xd8", jpeg_segment(0xe0, b"JFIF\0\1\1\0\0\1\0\1\0\0"), jpeg_segment(0xdb, b"\0" + b"\1" * 64),
        jpeg_segment(frame, head + b"".join(bytes([i, sampling if i == 1 else 0x11, 0]) for i in ids)),
        *huffman,
        jpeg_segment(0xdd, struct.pack(">H", restart)) if restart else b"",
        jpeg_segment(0xda, bytes([components]) + b"".join(bytes([i, 0]) for i in ids) + rest), dc,
        b"\xff\xd9"])


def jpeg_seeds():
    add("jpeg", "valid_grey", jpeg())
    add("jpeg", "valid_three_components", jpeg(3))
    add("jpeg", "valid_four_components", jpeg(4))
    add("jpeg", "valid_subsampled", jpeg(3, sampling=0x22))
    add("jpeg", "valid_progressive", jpeg(3, frame=0xc2))
    add("jpeg", "valid_restarts", jpeg(restart=1))
    # The decoder keeps its tables in memory that held something else: what a file leaves out was in them.
    for tables in (0, 1):
        for kind, frame in (("", 0xc0), ("progressive_", 0xc2)):
            add("jpeg", f"{kind}with_{tables}_of_2_tables_read_far_past_the_others",
                jpeg(3, frame=frame, dc=bytes(range(64, 120)), tables=tables))
    add("jpeg", "broken_last_of_256_codes_was_another",
        jpeg(dc=b"\xff\0" * 9, codes=[0] * 7 + [255, 1] + [0] * 7))
    add("jpeg", "broken_table_of_4080_codes_wrote_past_its_array", jpeg(codes=[255] * 16))


# ---- HDR and PFM ----------------------------------------------------------------------------------------

def hdr(size, rows):
    return b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + size + b"\n" + rows


def hdr_seeds():
    row = b"\2\2\0\x08" + b"\x88\x40" + b"\x08" + bytes(range(8)) + b"\x84\1\x84\2" + b"\x88\x80"
    add("hdr", "valid_flat", hdr(b"-Y 2 +X 2", bytes(range(16))))
    add("hdr", "valid_runs", hdr(b"-Y 2 +X 8", row * 2))
    add("hdr", "broken_cut_in_a_run_never_ended", hdr(b"-Y 2 +X 8", row + row[:9]))
    add("hdr", "broken_stretch_of_no_bytes_never_ended", hdr(b"-Y 1 +X 8", b"\2\2\0\x08" + bytes(32)))
    add("hdr", "broken_run_over_the_end", hdr(b"-Y 1 +X 8", b"\2\2\0\x08" + b"\xff\1" * 4 + bytes(16)))
    add("hdr", "broken_larger_than_its_file", hdr(b"-Y 32768 +X 32767", row))


def pfm_seeds():
    floats = struct.pack("<6f", 0, 1, -1, 1e30, float("inf"), float("nan"))
    add("pfm", "valid_rgb", b"PF\n2 1\n-1.0\n" + floats)
    add("pfm", "valid_grey_big_endian", b"Pf\n3 2\n1\n" + floats)
    add("pfm", "broken_larger_than_its_file", b"PF\n32768 32768\n-1\n" + floats)


# ---- EXR ------------------------------------------------------------------------------------------------

def exr(width, height, channels, compression, chunks, lines):
    def attribute(name, kind, value):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value

    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    listed = b"".join(n + b"\0" + struct.pack("<iBxxxii", kind, 0, *(each or (1, 1)))
                      for n, kind, *each in channels) + b"\0"
    head = b"".join([
        b"\x76\x2f\x31\x01\2\0\0\0", attribute(b"channels", b"chlist", listed),
        attribute(b"compression", b"compression", bytes([compression])),
        attribute(b"dataWindow", b"box2i", window), attribute(b"displayWindow", b"box2i", window),
        attribute(b"lineOrder", b"lineOrder", b"\0"),
        attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1)),
        attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0)),
        attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)), b"\0"])
    offsets, body, at = b"", b"", len(head) + 8 * len(chunks)
    for index, data in enumerate(chunks):
        offsets += struct.pack("<Q", at + len(body))
        body += struct.pack("<ii", index * lines, len(data)) + data
    return head + offsets + body


def exr_delta(data):
    """What comes before deflate and before run lengths: even bytes, odd bytes, then differences."""
    data = data[::2] + data[1::2]
    return bytes([data[0]] + [(data[i] - data[i - 1] + 128) & 255 for i in range(1, len(data))])


def exr_runs(data):
    runs, at = b"", 0
    while at < len(data):
        count = 1
        while at + count < len(data) and data[at + count] == data[at] and count < 128:
            count += 1
        stretch = bytes([256 - count]) + data[at:at + count]
        runs += bytes([count - 1, data[at]]) if count > 2 else stretch
        at += count
    return runs


def exr_seeds():
    rgb, half = [(b"B", 2), (b"G", 2), (b"R", 2)], [(b"Y", 1)]
    whole = [(n, 1) for n in (b"A", b"B", b"G", b"R")]
    line = struct.pack("<12f", *range(12))
    flat = struct.pack("<64e", *[1.5] * 64)
    add("exr", "valid_float", exr(4, 2, rgb, 0, [line, line], 1))
    add("exr", "valid_half_grey", exr(8, 1, half, 0, [struct.pack("<8e", *range(8))], 1))
    add("exr", "valid_half_rgba", exr(2, 2, whole, 0, [struct.pack("<8e", *range(8))] * 2, 1))
    add("exr", "valid_runs", exr(8, 2, half, 1, [exr_runs(exr_delta(flat[:16]))] * 2, 1))
    add("exr", "valid_deflated_lines", exr(32, 2, half, 2, [zlib.compress(exr_delta(flat[:64]))] * 2, 1))
    add("exr", "valid_deflated_blocks", exr(32, 2, half, 3, [zlib.compress(exr_delta(flat))], 16))
    for extra in (b"!", b"Z"):
        add("exr", f"valid_with_{'first' if extra < b'A' else 'last'}_of_four_halves_unread_wrote_to_null",
            exr(2, 2, sorted([*whole[1:], (extra, 1)]), 0, [struct.pack("<8e", *range(8))] * 2, 1))
    add("exr", "broken_unread_channel_of_every_other_line_made_others_run_over",
        exr(999, 2, [(b"B", 1), (b"G", 1), (b"R", 1), (b"Z", 1, 1, 2)], 0, [bytes(999 * 8), bytes(999 * 6)], 1))
    for name, compression, lines in (("wavelets", 4, 32), ("pxr24", 5, 16), ("b44", 6, 32), ("b44a", 7, 32),
                                     ("dwa_lines", 8, 32), ("dwa_blocks", 9, 256)):
        add("exr", f"{name}_of_zeros", exr(32, 2, half, compression, [bytes(60)], lines))
    add("exr", "broken_larger_than_its_file", exr(32767, 32767, rgb, 3, [], 16))


# ---- glTF -----------------------------------------------------------------------------------------------

def glb(document, binary=b""):
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    if binary:
        chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


class Scene:
    def __init__(self):
        self.binary, self.views, self.accessors = b"", [], []

    def view(self, data):
        self.binary += b"\0" * (-len(self.binary) % 4)
        self.views.append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)})
        self.binary += data
        return len(self.views) - 1

    def accessor(self, data, component, kind, count, **more):
        row = {"componentType": component, "type": kind, "count": count, **more}
        if data:
            row["bufferView"] = self.view(data)
        self.accessors.append(row)
        return len(self.accessors) - 1

    def glb(self, **more):
        return glb({"asset": {"version": "2.0"}, "buffers": [{"byteLength": len(self.binary)}],
                    "bufferViews": self.views, "accessors": self.accessors, **more}, self.binary)


def scene_of_everything():
    s = Scene()
    square = struct.pack("<12f", 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0)
    position = s.accessor(square, 5126, "VEC3", 4)
    uv = s.accessor(struct.pack("<8f", *[0, 0, 1, 0, 1, 1, 0, 1]), 5126, "VEC2", 4)
    uv_bytes = s.accessor(bytes([0, 0, 255, 0, 255, 255, 0, 255]), 5121, "VEC2", 4, normalized=True)
    color = s.accessor(bytes(range(16)), 5121, "VEC4", 4, normalized=True)
    strip = s.accessor(struct.pack("<4H", 0, 1, 3, 2), 5123, "SCALAR", 4)
    triangles = s.accessor(struct.pack("<6I", 0, 1, 2, 0, 2, 3), 5125, "SCALAR", 6)
    places, values = s.view(b"\2"), s.view(square[:12])
    sparse = s.accessor(square, 5126, "VEC3", 4, sparse={
        "count": 1, "indices": {"bufferView": places, "componentType": 5121},
        "values": {"bufferView": values}})
    quantized = s.accessor(struct.pack("<16h", *range(16)), 5122, "VEC4", 4, normalized=True)
    picture = s.view(png(2, 2, 8, 6, b"\0" + bytes(range(8)) + b"\0" + bytes(range(8))))
    moved = {"KHR_texture_transform": {"offset": [0, 1], "rotation": 1, "scale": [2, 2], "texCoord": 1}}
    return s.glb(
        extensionsUsed=["KHR_texture_transform", "KHR_lights_punctual", "KHR_materials_emissive_strength",
                        "KHR_materials_unlit", "KHR_mesh_quantization", "EXT_unknown"],
        images=[{"bufferView": picture, "mimeType": "image/png"}],
        samplers=[{"wrapS": 33071, "magFilter": 9728}],
        textures=[{"source": 0, "sampler": 0}, {"source": 0}],
        materials=[
            {"name": "a", "alphaMode": "MASK", "emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 1},
             "normalTexture": {"index": 0, "scale": 0.5, "texCoord": 1}, "doubleSided": True,
             "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions": moved}},
             "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 5}}},
            {"extensions": {"KHR_materials_unlit": {}}, "occlusionTexture": {"index": 1, "strength": 0.5}}],
        meshes=[{"primitives": [
            {"mode": 5, "attributes": {"POSITION": position, "TEXCOORD_0": uv, "TEXCOORD_1": uv_bytes,
                                       "COLOR_0": color}, "indices": strip, "material": 0},
            {"attributes": {"POSITION": sparse, "NORMAL": position}, "indices": triangles, "material": 1},
            {"mode": 6, "attributes": {"POSITION": position, "TANGENT": quantized}},
            {"mode": 1, "attributes": {"POSITION": position}}]}],
        cameras=[{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}},
                 {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 9}}],
        extensions={"KHR_lights_punctual": {"lights": [
            {"type": "spot", "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.5}, "intensity": 9},
            {"type": "point", "range": 5, "color": [1, 0.5, 0.25]}, {"type": "directional"}]}},
        scene=0, scenes=[{"nodes": [0]}],
        nodes=[{"children": [1, 2, 3], "scale": [2, 2, -2], "translation": [1, 2, 3]},
               {"mesh": 0, "rotation": [0, 0, 1, 0], "name": "n"},
               {"camera": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}},
               {"camera": 1, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1],
                "extensions": {"KHR_lights_punctual": {"light": 2}}, "children": [4]},
               {"extensions": {"KHR_lights_punctual": {"light": 1}}}])


# A pyramid without a floor, from draco_encoder -qp 8, -cl 7 and -method sequential, and from meshoptimizer; and
# a picture of 2 x 2 texels from cwebp, with -lossless and without.
PACKED = {name: base64.b64decode(text) for name, text in {
    "edgebreaker": "RFJBQ08CAgEBAAAABQQABAAAAm8B/wERAf8AAAEACQMAAAIBAQEBA4ACERFFBBUR////680MzQwHTrN8ByRPgAAAAAD/AAAAAAAA"
                   "AAAAAAAAAAAAAACAPwg=",
    "sequential": "RFJBQ08CAgEAAAAEBQEAAQIBAwIDBAIEAAIBAQAJAwAAAgABAQAJA5kZzQwTnRkDV6GxSP9/gL+/gAAAAAAA/wAAAAAAAAAAAAAA"
                  "AAAAAAAAgD8I",
    "vertices": "oAAAATMAAAD//wEzwAAAfn1+AAABDMAAAP//AQwAAAB+AAABAMAAAP8BAMAAAH4AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA"
                "AAAAAA==",
    "triangles": "4P4QAAQPCAB2h1ZneKmGZYlomAFpAAA=",
    "indices": "0AAEDAoECAYEBAIKEAAAAAA=",
    "lossless": "UklGRh4AAABXRUJQVlA4TBEAAAAvAUAAAA+w//Mf8x8VMqL/AQA=",
    "lossy": "UklGRjoAAABXRUJQVlA4IC4AAACwAQCdASoCAAIAAgA0JaACdAEO/gLsAM4+b/zhItX/zYH/t5/4I96RV6u8gAAA",
}.items()}


def packed_seeds():
    for name in ("edgebreaker", "sequential"):
        s = Scene()
        packed = {"bufferView": s.view(PACKED[name]), "attributes": {"POSITION": 0}}
        s.accessor(b"", 5126, "VEC3", 5)
        s.accessor(b"", 5125, "SCALAR", 12)
        add("gltf", "packed_draco_" + name, s.glb(nodes=[{"mesh": 0}], meshes=[{"primitives": [{
            "attributes": {"POSITION": 0}, "indices": 1,
            "extensions": {"KHR_draco_mesh_compression": packed}}]}]))
    for name, mode in (("triangles", "TRIANGLES"), ("indices", "INDICES")):
        s = Scene()
        for data, count, stride, kind in ((PACKED["vertices"], 5, 12, "ATTRIBUTES"), (PACKED[name], 12, 4, mode)):
            s.views[s.view(data)]["extensions"] = {"EXT_meshopt_compression": {
                "buffer": 0, "byteOffset": len(s.binary) - len(data), "byteLength": len(data),
                "byteStride": stride, "count": count, "mode": kind, "filter": "NONE"}}
        s.accessors = [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 5},
                       {"bufferView": 1, "componentType": 5125, "type": "SCALAR", "count": 12}]
        add("gltf", "packed_meshopt_" + name, s.glb(nodes=[{"mesh": 0}], meshes=[{"primitives": [{
            "attributes": {"POSITION": 0}, "indices": 1}]}]))
    for name in ("lossless", "lossy"):
        s = Scene()
        s.view(PACKED[name])
        add("gltf", "packed_webp_" + name, s.glb(
            images=[{"bufferView": 0}], textures=[{"extensions": {"EXT_texture_webp": {"source": 0}}}]))


def pose_seeds():
    s = Scene()
    triangle = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    position = s.accessor(triangle, 5126, "VEC3", 3)
    joints = s.accessor(bytes([0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0]), 5121, "VEC4", 3)
    weights = s.accessor(struct.pack("<12f", 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0), 5126, "VEC4", 3)
    bind = s.accessor(struct.pack("<32f", *[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] * 2), 5126, "MAT4", 2)
    times = s.accessor(struct.pack("<2f", 0, 2), 5126, "SCALAR", 2)
    turns = s.accessor(struct.pack("<8f", 0, 0, 0, 1, 0, 0, 1, 0), 5126, "VEC4", 2)
    moves = s.accessor(struct.pack("<18f", *range(18)), 5126, "VEC3", 6)
    mixes = s.accessor(struct.pack("<2f", 0, 1), 5126, "SCALAR", 2)
    add("gltf", "valid_pose", s.glb(
        meshes=[{"weights": [0.5], "primitives": [{
            "attributes": {"POSITION": position, "NORMAL": position, "JOINTS_0": joints, "WEIGHTS_0": weights},
            "targets": [{"POSITION": position, "NORMAL": position}]}]}],
        skins=[{"joints": [1, 2], "inverseBindMatrices": bind}],
        nodes=[{"mesh": 0, "skin": 0}, {"children": [2]}, {"translation": [1, 0, 0]}, {"mesh": 0}],
        animations=[{
            "samplers": [{"input": times, "output": turns}, {"input": times, "output": mixes,
                                                              "interpolation": "STEP"},
                         {"input": times, "output": moves, "interpolation": "CUBICSPLINE"}],
            "channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}},
                         {"sampler": 1, "target": {"node": 3, "path": "weights"}},
                         {"sampler": 2, "target": {"node": 2, "path": "translation"}}]}]))


def gltf_seeds():
    a, tri = '"asset":{"version":"2.0"}', struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    add("gltf", "valid_everything", scene_of_everything())
    add("gltf", "valid_text", json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64," +
                     base64.b64encode(tri).decode()}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}]}))
    add("gltf", "broken_key_given_twice_took_quadratic_time",
        "{%s,%s,%s}" % (a, ",".join(['"a":0'] * 500), ",".join(['"skins":[]'] * 500)))
    add("gltf", "broken_cycle_of_nodes",
        '{%s,"scenes":[{"nodes":[0]}],"nodes":[{"children":[1]},{"children":[0]}]}' % a)
    add("gltf", "broken_deep_arrays", "{%s,\"extras\":%s%s}" % (a, "[" * 5000, "]" * 5000))
    deep = ",".join('{"children":[%d]}' % (i + 1) for i in range(300)) + ",{}"
    add("gltf", "valid_deep_nodes", '{%s,"scenes":[{"nodes":[0]}],"nodes":[%s]}' % (a, deep))
    add("gltf", "broken_leads_outside", '{%s,"buffers":[{"byteLength":1,"uri":"%%2e%%2e/secret"}]}' % a)
    add("gltf", "broken_buffer_is_the_file_itself_and_short",
        '{%s,"buffers":[{"byteLength":99999,"uri":"fuzzed.glb"}]}' % a)
    for name, node in (("far", {"mesh": 0, "translation": [1e300, -1e300, 1e300]}),
                       ("vast", {"mesh": 0, "scale": [1e250] * 3}),
                       ("tiny", {"mesh": 0, "scale": [1e-300] * 3})):
        s = Scene()
        s.accessor(tri, 5126, "VEC3", 3)
        add("gltf", name, s.glb(meshes=[{"primitives": [{"attributes": {"POSITION": 0}}]}], nodes=[node],
                                scenes=[{"nodes": [0]}]))
    s = Scene()
    s.accessor(b"", 5126, "VEC3", 1000000)
    add("gltf", "broken_a_million_vertices_without_data_took_seconds",
        s.glb(meshes=[{"primitives": [{"attributes": {"POSITION": 0}}] * 6}]))
    s = Scene()
    s.accessor(b"", 5126, "VEC3", 999999999999999)
    add("gltf", "broken_count_beyond_memory",
        s.glb(meshes=[{"primitives": [{"attributes": {"POSITION": 0}}]}]))


# ---- Views and walks ------------------------------------------------------------------------------------

def view_seeds():
    camera = {"position": [0, 1, 5], "look_at": [0, 1, 0], "up": [0, 1, 0], "yfov_deg": 60}
    add("view", "valid_everything", json.dumps({
        "camera": camera, "sky": {"zenith": [1, 1, 2], "horizon": [1, 1, 1], "ground": [0.1, 0.1, 0.1]},
        "sun": {"direction": [0, -1, 0.2], "irradiance": [3, 3, 3], "angle_deg": 0.5},
        "fog": {"density": 0.1, "albedo": [1, 1, 0.9], "height_falloff": 0.2, "height": 2, "anisotropy": 0.5},
        "lights": [{"type": "point", "position": [0, 2, 0], "intensity": [9, 9, 9], "radius": 0.1,
                    "range": 9},
                   {"type": "spot", "position": [0, 2, 0], "intensity": [9, 9, 9], "direction": [0, -1, 0],
                    "inner_deg": 10, "outer_deg": 30}],
        "punctual_scale": 1, "emissive_scale": 2, "materials": "lambert", "default_albedo": [0.5, 0.5, 0.5]}))
    add("view", "valid_uniform_sky",
        json.dumps({"camera": camera, "sky": {"radiance": [1, 1, 1]}, "sun": None, "fog": None}))
    add("view", "valid_text", json.dumps({"camera": camera, "sky": "1,2,3,4,5,6,7,8,9", "sun": "0,-1,0,1,2,3"}))
    add("view", "broken_sky_of_two_numbers", json.dumps({"camera": camera, "sky": "1,2"}))
    add("view", "broken_environment_and_sky",
        json.dumps({"camera": camera, "environment": "a.hdr", "sky": "day"}))
    add("view", "broken_hidden_by_a_zero", json.dumps({"camera": camera}) + "\0{}")
    add("view", "broken_looks_along_up", json.dumps({"camera": {**camera, "look_at": [0, 9, 5]}}))
    add("view", "broken_key_given_twice", '{"camera":%s,"camera":0}' % json.dumps(camera))


def path_seeds():
    add("path", "valid_points",
        '{"points":[[0,1,0],[3,1,0],[3,2,4],[0,1,9]],"speed_m_s":3,"fps":30,"yfov_deg":70}')
    add("path", "valid_looks", json.dumps({
        "points": [{"position": [0, 1, 0], "look_at": [5, 1, 0]}, [3, 1, 0], {"position": [3, 1, 5]}],
        "smooth_m": 0.5, "view": "a.json"}))
    add("path", "valid_looks_at_one_place", '{"points":[[0,1,0],[3,1,0]],"look_at":[1,0,-4],"smooth_m":0}')
    add("path", "broken_negative_zero_made_a_length_of_nan", '{"points":[[0,1,0],[-0.0,1,0],[1,1,0]]}')
    add("path", "broken_denormal_step_made_a_length_of_nan", '{"points":[[0,0,0],[1e-200,0,0]]}')
    add("path", "broken_out_and_back_to_the_same_point", '{"points":[[0,1,0],[0,1,0]]}')


# ---- What the program wrote itself ----------------------------------------------------------------------

def state_seeds():
    # Only what the target's `mend` makes of it belongs to the target's picture.
    head = b"raycst02" + bytes(32) + struct.pack("<4I", 4, 4, 513, 16)
    samples = struct.pack("<96d", *[4.0] * 96)
    add("state", "valid_once_mended", head + struct.pack("<I", 4) + samples)
    add("state", "valid_mended_with_the_most_samples", head + b"\xff" * 4 + samples)
    add("state", "broken_of_another_scene", head + struct.pack("<I", 4) + samples)
    add("state", "broken_mended_without_samples", head + bytes(4 + 8 * 96))
    add("state", "broken_mended_and_too_long", head + struct.pack("<I", 4) + samples + b"x")
    add("state", "broken_short", head[:40])


def cache_seeds():
    def cache(data, checksum=None):
        total = 0xcbf29ce484222325
        for byte in data:
            total = (total ^ byte) * 0x100000001b3 & (1 << 64) - 1
        return b"sdfgi-1\0" + struct.pack("<QQ", len(data), total if checksum is None else checksum) + data

    head = struct.pack("<IIII16s", 32, 1, 0x5df, 0x91, b"fuzzed driver..")
    add("cache", "valid_header_alone", cache(head))
    add("cache", "valid_data", cache(head + bytes(range(31))))
    add("cache", "broken_of_another_driver", cache(head[:16] + bytes(16)))
    add("cache", "broken_checksum", cache(head, 0))
    add("cache", "broken_shorter_than_a_header", cache(head[:31]))
    add("cache", "broken_header_longer_than_the_data", cache(b"\xff\0\0\0" + head[4:]))
    add("cache", "broken_claims_gigabytes", b"sdfgi-1\0" + struct.pack("<QQ", 1 << 40, 0))


def text_seeds():
    add("settings", "valid_settings", "\n".join([
        "sdfgi_enabled=true", "sdfgi_cascades=4", "sdfgi_min_cell_size=0.2", "sdfgi_y_scale=75%",
        "sdfgi_energy=1e0", "sdfgi_resolution=64", "sdfgi_visibility=probe_depth",
        "sdfgi_cascade0_distance=25.6",
        "sdfgi_max_distance=204.8", "sdfgi_ray_count=16", "sdfgi_energy=nan", "x=1", "sdfgi_cascades=-1"]))
    add("cli", "valid_arguments", "\n".join([
        "scene.glb", "--out=x", "--spp", "64", "--seed=18", "--time=0.5", "--size", "320x180", "--set=a=b",
        "--gi", "off", "--flag", "--", "--x"]))
    add("cli", "valid_help", "--help")
    add("cli", "broken_size", "scene.glb\n--size\n0x1e9")


for write in (png_seeds, jpeg_seeds, hdr_seeds, pfm_seeds, exr_seeds, gltf_seeds, packed_seeds, pose_seeds,
              view_seeds, path_seeds, state_seeds, cache_seeds, text_seeds):
    write()
# Whatever can be imported can be traced.
files.update({f"trace/{path[5:]}": data for path, data in files.items() if path.startswith("gltf/")})
for path, content in files.items():
    out = pathlib.Path(sys.argv[1]) / path
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_bytes(content)

# SPDX-License-Identifier: MIT
"""Small PNG files from the strips that `sdfgi compare` writes."""
import concurrent.futures
import struct
import zlib

# Of a strip in the documentation, which is kept with the sources.
BYTES_MAX = 40 * 1024
SIGNATURE = b"\x89PNG\r\n\x1a\n"


def paeth(left, up, corner):
    guess = left + up - corner
    distances = abs(guess - left), abs(guess - up), abs(guess - corner)
    if distances[0] <= distances[1] and distances[0] <= distances[2]:
        return left
    return up if distances[1] <= distances[2] else corner


def predict(kind, left, up, corner):
    return (0, left, up, (left + up) // 2, paeth(left, up, corner))[kind]


def decode(data):
    """Width, height and rows of an 8-bit RGB file."""
    at, body, size = len(SIGNATURE), b"", (0, 0)
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        chunk = data[at + 8 : at + 8 + length]
        if kind == b"IHDR":
            size = struct.unpack(">II", chunk[:8])
        elif kind == b"IDAT":
            body += chunk
        at += 12 + length
    raw, stride = zlib.decompress(body), 3 * size[0]
    rows, above = [], bytes(stride)
    for y in range(size[1]):
        line = bytearray(raw[y * (stride + 1) + 1 : (y + 1) * (stride + 1)])
        kind = raw[y * (stride + 1)]
        for x in range(stride):
            left, corner = (line[x - 3], above[x - 3]) if x >= 3 else (0, 0)
            line[x] = (line[x] + predict(kind, left, above[x], corner)) & 255
        rows.append(bytes(line))
        above = rows[-1]
    return size[0], size[1], rows


def chunk_bytes(kind, body):
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def filtered(rows, bits):
    """Rows with only the `bits` upper bits of each value, as differences to the row above or the texel before,
    whichever sums up to less."""
    step = 1 << (8 - bits)
    table = bytes(min(255, (v + step // 2) // step * step) for v in range(256))
    above, out = bytes(len(rows[0])), b""
    for row in (row.translate(table) for row in rows):
        candidates = []
        for kind, before in ((1, bytes(3) + row[:-3]), (2, above)):
            line = bytes((a - b) & 255 for a, b in zip(row, before))
            candidates.append((sum(min(v, 256 - v) for v in line), bytes([kind]) + line))
        out += min(candidates)[1]
        above = row
    return out


def encode(width, height, rows, bits):
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    body = zlib.compress(filtered(rows, bits), 9)
    return SIGNATURE + chunk_bytes(b"IHDR", header) + chunk_bytes(b"IDAT", body) + chunk_bytes(b"IEND", b"")


def halved(width, height, rows):
    """Means of squares of 2 x 2 texels."""
    out = []
    for y in range(0, height - 1, 2):
        above, below = rows[y], rows[y + 1]
        line = bytearray()
        for x in range(0, 3 * (width - 1), 6):
            line += bytes((above[x + c] + above[x + 3 + c] + below[x + c] + below[x + 3 + c] + 2) // 4 for c in range(3))
        out.append(bytes(line))
    return width // 2, height // 2, out


def fitting(width, height, rows):
    """With as many bits a channel as the size allows, or smaller: noise of the truth does not compress."""
    while True:
        for bits in (8, 7, 6, 5):
            data = encode(width, height, rows, bits)
            if len(data) <= BYTES_MAX:
                return data
        width, height, rows = halved(width, height, rows)


def shrink(source, target):
    target.write_bytes(fitting(*decode(source.read_bytes())))


def shrink_all(bench, chosen):
    folder = bench.args.docs / "accuracy"
    folder.mkdir(parents=True, exist_ok=True)
    sources = [bench.path(scene, "renderer.triangles.picture", ".png") for scene in chosen]
    targets = [folder / f"{scene['name']}.png" for scene in chosen]
    with concurrent.futures.ProcessPoolExecutor() as pool:
        list(pool.map(shrink, sources, targets))

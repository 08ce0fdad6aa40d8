// SPDX-License-Identifier: MIT
//
// What stb_image trusts in a JPEG and must not.
#include "import.h"

#include <algorithm>

namespace gltf
{

namespace
{

constexpr unsigned char marker_tables = 0xc4, marker_scan = 0xda;
// Each scan visits all pixels, however few bytes it has. Encoders write about ten.
constexpr size_t max_scans = 64;
// More would not fit its arrays, and one more it takes for another. No JPEG has more than 176 kinds of
// symbol.
constexpr size_t max_codes = 255;

// Where a JPEG's first segment is that is neither an application's nor a comment: those hold other data,
// often a whole small JPEG, and the decoder skips them by their length as is done here.
size_t jpeg_tables_start(const byte_range &file)
{
    size_t at = 0;
    while (at < file.size && file.data[at] == 0xff)
        at++;
    at = std::min(at + 1, file.size); // past the marker that starts the image, which fill bytes may precede
    while (file.size - at >= 4 && file.data[at] == 0xff) {
        const unsigned char marker = file.data[at + 1];
        const size_t length = static_cast<size_t>(file.data[at + 2]) << 8 | file.data[at + 3];
        const bool is_skipped = (marker >= 0xe0 && marker <= 0xef) || marker == 0xfe;
        if (!is_skipped || length < 2 || length > file.size - at - 2)
            break;
        at += 2 + length;
    }
    return at;
}

// Bytes past the end of the file count as zero, as they do in the decoder.
size_t byte_at(const byte_range &file, size_t index)
{
    return index < file.size ? file.data[index] : 0;
}

// Each table: an id, 16 numbers of codes, one byte per code. The decoder starts on a table while any of the
// segment's length is left, and then reads it whole.
void huffman_tables_check(const byte_range &file, size_t segment, const std::string &what)
{
    const size_t length = byte_at(file, segment) << 8 | byte_at(file, segment + 1);
    for (size_t used = 2; used < length;) {
        size_t codes = 0;
        for (size_t i = 1; i <= 16; i++)
            codes += byte_at(file, segment + used + i);
        if (codes > max_codes)
            fail("%s: a Huffman table of the JPEG has %zu codes", what.c_str(), codes);
        used += 17 + codes;
    }
}

} // namespace

// stb_image 2.27, which Debian 12 has, writes past its arrays where a Huffman table declares more than 256
// codes (2.28 checks). In image data a 0xff byte is followed by zero or by a restart, so every other pair is
// a marker.
void jpeg_check(const byte_range &file, const std::string &what)
{
    size_t scans = 0;
    if (byte_at(file, 0) != 0xff)
        return; // not a JPEG
    for (size_t i = jpeg_tables_start(file); i + 1 < file.size; i++) {
        if (file.data[i] != 0xff)
            continue;
        if (file.data[i + 1] == marker_tables)
            huffman_tables_check(file, i + 2, what);
        scans += file.data[i + 1] == marker_scan;
    }
    if (scans > max_scans)
        fail("%s: the JPEG has %zu scans, the limit is %zu", what.c_str(), scans, max_scans);
}

} // namespace gltf

// SPDX-License-Identifier: MIT
//
// Files: reading them whole, splitting a .glb into its chunks, and finding what a URI refers to.
#include "import.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <sys/stat.h>

namespace gltf
{

namespace
{

struct file_closer {
    void operator()(FILE *f) const
    {
        fclose(f);
    }
};

uint32_t read_u32(const unsigned char *p)
{
    return static_cast<uint32_t>(p[0]) | static_cast<uint32_t>(p[1]) << 8 |
           static_cast<uint32_t>(p[2]) << 16 | static_cast<uint32_t>(p[3]) << 24;
}

constexpr uint32_t chunk_json = 0x4E4F534A;
constexpr uint32_t chunk_binary = 0x004E4942;

// The parser's own splitting reads up to eight bytes past a file whose last chunk claims them, so it is not
// used. Sizes are compared by subtraction: nothing here can overflow.
void glb_split(container &box)
{
    const unsigned char *const p = box.file.data();
    if (box.file.size() < 20)
        fail("truncated: a binary glTF starts with 20 bytes, and there are %zu", box.file.size());
    if (read_u32(p + 4) != 2)
        fail("binary glTF version %u is not supported, only 2", static_cast<unsigned>(read_u32(p + 4)));
    const size_t length = read_u32(p + 8);
    if (length > box.file.size() || length < 20)
        fail("truncated: the header promises %zu bytes, and there are %zu", length, box.file.size());
    if (read_u32(p + 16) != chunk_json)
        fail("the first chunk of the binary glTF is not JSON");
    const size_t json_size = read_u32(p + 12);
    if (json_size > length - 20)
        fail("truncated: the JSON chunk promises %zu bytes, and %zu are left", json_size, length - 20);
    box.json = reinterpret_cast<const char *>(p) + 20;
    box.json_size = json_size;
    const size_t at = 20 + json_size;
    if (length - at < 8)
        return;
    const size_t binary_size = read_u32(p + at);
    if (binary_size > length - at - 8)
        fail("truncated: the second chunk promises %zu bytes, and %zu are left", binary_size,
             length - at - 8);
    if (read_u32(p + at + 4) != chunk_binary)
        return; // readers must skip chunks of unknown type
    box.binary = p + at + 8;
    box.binary_size = binary_size;
}

int hex_digit(char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    const char lower = static_cast<char>(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

std::string percent_decode(const std::string &in)
{
    std::string out;
    for (size_t i = 0; i < in.size(); i++) {
        const bool escape = in[i] == '%' && in.size() - i > 2;
        const int high = escape ? hex_digit(in[i + 1]) : -1;
        const int low = escape ? hex_digit(in[i + 2]) : -1;
        if (high < 0 || low < 0) {
            out += in[i];
            continue;
        }
        out += static_cast<char>(high * 16 + low);
        i += 2;
    }
    return out;
}

// A scene file from elsewhere must not be able to name files outside its own folder.
bool path_stays_inside(const std::string &path)
{
    if (path.empty() || path[0] == '/' || path.find('\0') != std::string::npos)
        return false;
    int depth = 0;
    for (size_t from = 0; from <= path.size();) {
        const size_t slash = std::min(path.find('/', from), path.size());
        const std::string part = path.substr(from, slash - from);
        if (part == "..")
            depth--;
        else if (!part.empty() && part != ".")
            depth++;
        if (depth < 0)
            return false;
        from = slash + 1;
    }
    return true;
}

// Without links; empty where there is no such file.
std::string real_path(const std::string &path)
{
    const std::unique_ptr<char, void (*)(void *)> real(realpath(path.c_str(), nullptr), free);
    return real ? real.get() : "";
}

// Nor may links in its folder lead there. A file that is missing leads nowhere; reading it says so.
bool links_stay_inside(const std::string &folder, const std::string &file)
{
    const std::string top = real_path(folder.empty() ? "." : folder);
    if (top.empty() || file.empty() || top == "/")
        return true;
    return file.compare(0, top.size(), top) == 0 && (file.size() == top.size() || file[top.size()] == '/');
}

bytes named_file_read(importer &in, const std::string &path, const std::string &real, uint64_t limit)
{
    bytes out = file_read(path, limit);
    if (in.files_read.insert(real).second)
        in.input_bytes += out.size();
    bound_take(in, in.read_bytes, out.size(), read_bound, "named again and again");
    return out;
}

} // namespace

bytes file_read(const std::string &path, uint64_t limit)
{
    // Only plain files: opening a pipe or a device could wait for ever.
    struct stat status;
    if (stat(path.c_str(), &status) != 0)
        fail("%s", strerror(errno));
    if (!S_ISREG(status.st_mode))
        fail("not a plain file");
    if (static_cast<uint64_t>(status.st_size) > limit)
        fail("larger than %llu bytes, which are left of the limit of 4 GiB",
             static_cast<unsigned long long>(limit));
    const std::unique_ptr<FILE, file_closer> file(fopen(path.c_str(), "rb"));
    if (!file)
        fail("%s", strerror(errno));
    bytes out(static_cast<size_t>(status.st_size));
    if (fread(out.data(), 1, out.size(), file.get()) != out.size())
        fail("cannot be read to its end");
    return out;
}

container container_read(const std::string &path)
{
    container box;
    box.file = file_read(path, max_file_size);
    if (box.file.empty())
        fail("the file is empty");
    if (box.file.size() >= 4 && memcmp(box.file.data(), "glTF", 4) == 0) {
        glb_split(box);
        return box;
    }
    box.json = reinterpret_cast<const char *>(box.file.data());
    box.json_size = box.file.size();
    return box;
}

bytes resource_read(importer &in, const std::string &uri, const std::string &what, uint64_t limit)
{
    if (uri.compare(0, 5, "data:") == 0) {
        const size_t comma = uri.find(',');
        if (comma == std::string::npos || comma < 7 || uri.compare(comma - 7, 7, ";base64") != 0)
            fail("%s: the data URI is not base64", what.c_str());
        // The parser knows a fixed list of media types; which one it is does not matter here.
        bytes out;
        std::string media_type;
        const std::string plain = "data:application/octet-stream;base64," + uri.substr(comma + 1);
        if (!tinygltf::DecodeDataURI(&out, media_type, plain, 0, false))
            fail("%s: the data URI holds no base64 data", what.c_str());
        return out;
    }
    const std::string name = percent_decode(uri);
    if (!path_stays_inside(name))
        fail("%s: '%.200s' is not a path below the folder of the file", what.c_str(), name.c_str());
    const std::string real = real_path(in.folder + name);
    if (!links_stay_inside(in.folder, real))
        fail("%s: '%.200s' leads outside of the folder of the file", what.c_str(), name.c_str());
    try {
        return named_file_read(in, in.folder + name, real, limit);
    } catch (const bad_file &error) {
        fail("%s: '%.200s': %s", what.c_str(), name.c_str(), error.what());
    }
}

} // namespace gltf

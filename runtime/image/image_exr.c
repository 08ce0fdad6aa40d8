/* SPDX-License-Identifier: MIT
 * OpenEXR through its C core: scanline files with half or float channels R, G, B, A or Y. */
#include "image_codec.h"

#include <base/text.h>
#include <errno.h>
#include <openexr.h>
#include <stdlib.h>
#include <string.h>

enum { PIXEL_BYTES = 4 * sizeof(float), CHANNEL_COUNT = 4, MESSAGE_BYTES = 160 };

/* The densest of the compressions keeps 8 x 8 pixels as one number, and deflates a thousand to a byte. */
enum { PIXELS_PER_BYTE_MAX = 64 * 1032 };

static const char channel_names[CHANNEL_COUNT][2] = { "R", "G", "B", "A" };

struct stream {
    FILE *file; /* NULL when reading */
    char message[MESSAGE_BYTES];
};

/* Of contexts that read: those that write call it locked, and asking them for their stream waits for ever. */
static void keep_message(exr_const_context_t context, exr_result_t code, const char *text)
{
    void *user = NULL;
    (void)code;
    if (exr_get_user_data(context, &user) == EXR_ERR_SUCCESS && user)
        base_text_error(((struct stream *)user)->message, MESSAGE_BYTES, "%s", text);
}

static void ignore_message(exr_const_context_t context, exr_result_t code, const char *text)
{
    (void)context;
    (void)code;
    (void)text;
}

static int64_t write_bytes(exr_const_context_t context, void *user, const void *bytes, uint64_t size,
                           uint64_t offset, exr_stream_error_func_ptr_t report)
{
    struct stream *stream = user;
    (void)context;
    (void)report;
    if (fseeko(stream->file, (off_t)offset, SEEK_SET) == 0 && fwrite(bytes, 1, size, stream->file) == size)
        return (int64_t)size;
    base_text_error(stream->message, MESSAGE_BYTES, "the disk does not take any more");
    return -1;
}

static exr_context_initializer_t initializer(struct stream *stream)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = keep_message;
    init.user_data = stream;
    init.max_image_width = IMAGE_SIDE_MAX;
    init.max_image_height = IMAGE_SIDE_MAX;
    return init;
}

static bool fail(const struct stream *stream, exr_result_t code, char *error, size_t error_size)
{
    /* Compressors without memory are reported as data that is broken. */
    const char *reason = code == EXR_ERR_OUT_OF_MEMORY || errno == ENOMEM ? "out of memory"
                         : stream->message[0]                             ? stream->message
                                              : exr_get_default_error_message(code);
    return base_text_error(error, error_size, "%s", reason);
}

/* ---- Reading ---------------------------------------------------------------------------------------- */

/* The place of a channel in RGBA, or -1. Luminance goes to red and is spread at the end. */
static int channel_slot(const char *name)
{
    for (int i = 0; i < CHANNEL_COUNT; i++)
        if (strcmp(name, channel_names[i]) == 0)
            return i;
    return strcmp(name, "Y") == 0 ? 0 : -1;
}

/* Channels that are not read count as well. The library chooses its routine for three or four channels among
 * those that have samples on a line, and then takes all channels for whole ones. */
static bool check_channels(const exr_attr_chlist_t *list, uint32_t *channels, char *error, size_t error_size)
{
    uint32_t found = 0;
    for (int i = 0; i < list->num_channels; i++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[i];
        const char *const name = entry->name.str;
        const int slot = channel_slot(name);
        if (entry->x_sampling != 1 || entry->y_sampling != 1)
            return base_text_error(error, error_size, "channel %s is subsampled", name);
        if (slot < 0)
            continue;
        if (entry->pixel_type == EXR_PIXEL_UINT)
            return base_text_error(error, error_size, "channel %s is an integer, expected half or float",
                                   name);
        found |= 1u << slot;
    }
    const bool grey = (found & 7) == 1, colour = (found & 7) == 7;
    if (!grey && !colour)
        return base_text_error(error, error_size, "expected channels R, G, B or Y");
    *channels = found & 8 ? 4 : grey ? 1 : 3;
    return true;
}

/* Where samples go: to `rgba`, and those of other channels to `unread`, with the same width. The library's
 * routines for three and four channels write all of them, wanted or not. */
struct destination {
    float *rgba, *unread;
    int32_t width;
};

static void set_destination(exr_coding_channel_info_t *channel, const struct destination *to)
{
    const int slot = channel_slot(channel->channel_name);
    const int32_t stride = slot < 0 ? (int32_t)sizeof(float) : PIXEL_BYTES;
    channel->decode_to_ptr = (uint8_t *)(slot < 0 ? to->unread : to->rgba + slot);
    channel->user_bytes_per_element = sizeof(float);
    channel->user_data_type = EXR_PIXEL_FLOAT;
    channel->user_pixel_stride = stride;
    channel->user_line_stride = stride * to->width;
}

static exr_result_t decode_chunk(exr_context_t context, const exr_chunk_info_t *chunk,
                                 const struct destination *to)
{
    exr_decode_pipeline_t decode = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_result_t code = exr_decoding_initialize(context, 0, chunk, &decode);
    if (code != EXR_ERR_SUCCESS)
        return code;
    for (int i = 0; i < decode.channel_count; i++)
        set_destination(&decode.channels[i], to);
    code = exr_decoding_choose_default_routines(context, 0, &decode);
    if (code == EXR_ERR_SUCCESS)
        code = exr_decoding_run(context, 0, &decode);
    exr_decoding_destroy(context, &decode);
    return code;
}

static exr_result_t decode_lines(exr_context_t context, struct image *image, int32_t first_line)
{
    int32_t step = 0;
    exr_result_t code = exr_get_scanlines_per_chunk(context, 0, &step);
    if (code != EXR_ERR_SUCCESS)
        return code;
    struct destination to = { .unread = calloc((size_t)image->width * (size_t)step, sizeof(float)),
                              .width = (int32_t)image->width };
    if (!to.unread)
        return EXR_ERR_OUT_OF_MEMORY;
    for (int32_t y = 0; code == EXR_ERR_SUCCESS && y < (int32_t)image->height; y += step) {
        exr_chunk_info_t chunk;
        to.rgba = image->rgba + 4 * (size_t)y * image->width;
        code = exr_read_scanline_chunk_info(context, 0, first_line + y, &chunk);
        if (code == EXR_ERR_SUCCESS)
            code = decode_chunk(context, &chunk, &to);
    }
    free(to.unread);
    return code;
}

static void complete_pixels(struct image *image)
{
    const size_t count = (size_t)image->width * image->height;
    for (size_t i = 0; i < count; i++) {
        float *pixel = image->rgba + 4 * i;
        if (image->channels == 1)
            pixel[1] = pixel[2] = pixel[0];
        if (image->channels != 4)
            pixel[3] = 1;
    }
}

static bool read_context(exr_context_t context, struct stream *stream, struct image *image,
                         uint64_t file_size, char *error, size_t error_size)
{
    exr_storage_t storage;
    exr_attr_box2i_t window;
    const exr_attr_chlist_t *list;
    uint32_t channels = 0;
    exr_result_t code = exr_get_storage(context, 0, &storage);
    if (code == EXR_ERR_SUCCESS && storage != EXR_STORAGE_SCANLINE)
        return base_text_error(error, error_size, "tiled or deep, expected scanlines");
    if (code == EXR_ERR_SUCCESS)
        code = exr_get_data_window(context, 0, &window);
    if (code == EXR_ERR_SUCCESS)
        code = exr_get_channels(context, 0, &list);
    if (code != EXR_ERR_SUCCESS)
        return fail(stream, code, error, error_size);
    const int64_t width = (int64_t)window.max.x - window.min.x + 1,
                  height = (int64_t)window.max.y - window.min.y + 1;
    if (width < 1 || height < 1 || width > IMAGE_SIDE_MAX || height > IMAGE_SIDE_MAX)
        return base_text_error(error, error_size, "broken picture: absurd data window");
    if (!check_channels(list, &channels, error, error_size) ||
        !image_init_backed(image, (uint32_t)width, (uint32_t)height,
                           (uint64_t)(width * height) / PIXELS_PER_BYTE_MAX, file_size, error, error_size))
        return false;
    image->channels = channels;
    code = decode_lines(context, image, window.min.y);
    if (code != EXR_ERR_SUCCESS)
        return fail(stream, code, error, error_size);
    complete_pixels(image);
    return true;
}

bool image_exr_read(struct image *image, const struct image_input *input, char *error, size_t error_size)
{
    struct stream stream = { 0 };
    const exr_context_initializer_t init = initializer(&stream);
    exr_context_t context;
    errno = 0;
    const exr_result_t code = exr_start_read(&context, input->path, &init);
    if (code != EXR_ERR_SUCCESS)
        return fail(&stream, code, error, error_size);
    const bool complete = read_context(context, &stream, image, input->size, error, error_size);
    exr_finish(&context);
    return complete;
}

/* ---- Writing ---------------------------------------------------------------------------------------- */

static exr_result_t write_header(exr_context_t context, const struct image_source *source)
{
    int part;
    exr_result_t code = exr_add_part(context, "image", EXR_STORAGE_SCANLINE, &part);
    if (code == EXR_ERR_SUCCESS)
        code = exr_initialize_required_attr_simple(context, part, (int32_t)source->width,
                                                   (int32_t)source->height, EXR_COMPRESSION_ZIP);
    for (uint32_t i = 0; code == EXR_ERR_SUCCESS && i < source->channels; i++)
        code = exr_add_channel(context, part, source->channels == 1 ? "Y" : channel_names[i], EXR_PIXEL_FLOAT,
                               EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    return code == EXR_ERR_SUCCESS ? exr_write_header(context) : code;
}

static exr_result_t encode_chunk(exr_context_t context, const exr_chunk_info_t *chunk, const float *rgba,
                                 int32_t width)
{
    exr_encode_pipeline_t encode = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_result_t code = exr_encoding_initialize(context, 0, chunk, &encode);
    if (code != EXR_ERR_SUCCESS)
        return code;
    for (int i = 0; i < encode.channel_count; i++) {
        exr_coding_channel_info_t *channel = &encode.channels[i];
        channel->encode_from_ptr = (const uint8_t *)(rgba + channel_slot(channel->channel_name));
        channel->user_bytes_per_element = sizeof(float);
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_pixel_stride = PIXEL_BYTES;
        channel->user_line_stride = PIXEL_BYTES * width;
    }
    code = exr_encoding_choose_default_routines(context, 0, &encode);
    if (code == EXR_ERR_SUCCESS)
        code = exr_encoding_run(context, 0, &encode);
    exr_encoding_destroy(context, &encode);
    return code;
}

static exr_result_t write_lines(exr_context_t context, const struct image_source *source)
{
    int32_t step = 0;
    exr_result_t code = exr_get_scanlines_per_chunk(context, 0, &step);
    for (int32_t y = 0; code == EXR_ERR_SUCCESS && y < (int32_t)source->height; y += step) {
        exr_chunk_info_t chunk;
        code = exr_write_scanline_chunk_info(context, 0, y, &chunk);
        if (code == EXR_ERR_SUCCESS)
            code = encode_chunk(context, &chunk, source->rgba + 4 * (size_t)y * source->width,
                                (int32_t)source->width);
    }
    return code;
}

bool image_exr_write(const struct image_source *source, FILE *file, char *error, size_t error_size)
{
    struct stream stream = { .file = file };
    exr_context_initializer_t init = initializer(&stream);
    init.write_fn = write_bytes;
    init.error_handler_fn = ignore_message;
    errno = 0;
    exr_context_t context;
    exr_result_t code = exr_start_write(&context, "picture", EXR_WRITE_FILE_DIRECTLY, &init);
    if (code != EXR_ERR_SUCCESS)
        return fail(&stream, code, error, error_size);
    code = write_header(context, source);
    if (code == EXR_ERR_SUCCESS)
        code = write_lines(context, source);
    const exr_result_t finished = exr_finish(&context);
    code = code == EXR_ERR_SUCCESS ? finished : code;
    return code == EXR_ERR_SUCCESS || fail(&stream, code, error, error_size);
}

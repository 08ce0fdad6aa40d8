/* SPDX-License-Identifier: MIT
 * Succeeds if a picture (PNG, PPM, HDR) can be read and shows at least two colours: a host that clears the
 * target and draws nothing fails. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <stb_image.h>

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: picture_colors FILE\n");
        return EXIT_FAILURE;
    }
    int width, height, channels;
    unsigned char *texels = stbi_load(argv[1], &width, &height, &channels, 3);
    if (!texels) {
        fprintf(stderr, "%s: %s\n", argv[1], stbi_failure_reason());
        return EXIT_FAILURE;
    }
    size_t others = 0;
    for (size_t i = 1; i < (size_t)width * (size_t)height; i++)
        others += memcmp(texels, texels + 3 * i, 3) != 0;
    stbi_image_free(texels);
    printf("%s: %d x %d, %zu pixels differ from the first\n", argv[1], width, height, others);
    return others ? EXIT_SUCCESS : EXIT_FAILURE;
}

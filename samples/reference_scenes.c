/* SPDX-License-Identifier: MIT
 *
 * Teaches: which small scenes put a light transport method to the test, and what the right answer is.
 *
 * Writes NAME.glb and NAME.view.json for each, and scenes.json, which lists them with the exact answer where
 * there is one. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cJSON.h>

#include "file_write.h"
#include "reference_scenes.h"

static const struct scene_row {
    const char *name;
    void (*build)(struct scene *scene, float a, float b);
    float a, b;
    double radiance; /* of the whole picture where it is one number; below 0: none */
    const char *shows;
} rows[] = {
    { "furnace_50", furnace_build, 0.5f, 0, 1, "energy: closed, albedo 0.5, emission 0.5" },
    { "furnace_80", furnace_build, 0.8f, 0, 1, "energy: closed, albedo 0.8, emission 0.2" },
    { "furnace_95", furnace_build, 0.95f, 0, 1, "energy: closed, albedo 0.95, emission 0.05" },
    { "sun_plane", sun_plane_build, 0.8f, 0, 2.5464791, "direct sun: 0.8 * 12.5 * 0.8 / pi" },
    { "sky_plane", sky_plane_build, 1, 0, 1, "uniform sky on a white plane" },
    { "right_angle", right_angle_build, 1, 0, -1,
      "a black wall of 8 m: (1 + d / sqrt(d^2 + 64)) / 2 at distance d" },
    { "point_light", point_light_build, 0.8f, 0, -1,
      "0.8 * 10 * cos / (pi d^2) under a lamp of 10 W/sr at 2 m" },
    { "cornell", cornell_build, 0, 0, -1, "the Cornell box with RGB colours, ten times its size" },
    { "two_rooms_w100_a0", two_rooms_build, 1, 0, 0,
      "closed room beside a lit one: wall of 1 m, five cells" },
    { "two_rooms_w80_a0", two_rooms_build, 0.8f, 0, 0,
      "closed room beside a lit one: wall of 0.8 m, four cells" },
    { "two_rooms_w80_a45", two_rooms_build, 0.8f, 45, 0, "the same, turned by 45 degrees" },
    { "two_rooms_w20_a0", two_rooms_build, 0.2f, 0, 0,
      "closed room beside a lit one: wall of 0.2 m, one cell" },
    { "two_rooms_w20_a45", two_rooms_build, 0.2f, 45, 0, "the same, turned by 45 degrees" },
    { "two_rooms_w10_a0", two_rooms_build, 0.1f, 0, 0,
      "closed room beside a lit one: wall of 0.1 m, half a cell" },
    { "two_rooms_w10_a45", two_rooms_build, 0.1f, 45, 0, "the same, turned by 45 degrees" },
    { "two_rooms_w5_a0", two_rooms_build, 0.05f, 0, 0,
      "closed room beside a lit one: wall of 5 cm, a quarter cell" },
    { "two_rooms_w5_a45", two_rooms_build, 0.05f, 45, 0, "the same, turned by 45 degrees" },
    { "two_rooms_door_a0", two_rooms_door_build, 0.2f, 0, 0,
      "light in a closet that juts into the closed room" },
    { "two_rooms_door_a45", two_rooms_door_build, 0.2f, 45, 0, "the same, turned by 45 degrees" },
    { "two_rooms_lit", two_rooms_lit_build, 0.2f, 0, -1, "the lit room, for the leak's measure" },
    { "sealed_room_w40", sealed_room_build, 0.4f, 0, 0,
      "closed all round, sun and sky outside: walls of 0.4 m" },
    { "sealed_room_w20", sealed_room_build, 0.2f, 0, 0, "walls of 0.2 m" },
    { "sealed_room_w5", sealed_room_build, 0.05f, 0, 0, "walls of 5 cm" },
    { "corridor", corridor_build, 0, 0, -1, "light along a corridor, from a doorway" },
    { "corridor_turn", corridor_turn_build, 0, 0, -1, "the same light, round a corner" },
    { "maze", maze_build, 0.04f, 0, -1, "thin walls of 4 cm, light from one open cell" },
    { "emitter_5", emitter_build, 0.05f, 0, -1, "lamp of 20 W/sr, 5 cm wide" },
    { "emitter_20", emitter_build, 0.2f, 0, -1, "the same power, 20 cm wide" },
    { "emitter_80", emitter_build, 0.8f, 0, -1, "the same power, 80 cm wide" },
    { "color_bleed", color_bleed_build, 0, 0, -1, "pure red and blue sides colour a white ball" },
    { "courtyard", courtyard_build, 0, 0, -1, "sky light alone, arcades" },
    { "pillars", pillars_build, 0, 0, -1, "contact shade at the feet of thin pillars" },
    { "many_lights", many_lights_build, 64, 0, -1, "64 point lights" },
    { "glossy_spheres", glossy_spheres_build, 0, 0, -1,
      "reflections, roughness 0.02 to 1, metal and dielectric" },
    { "white_metal_furnace", white_metal_furnace_build, 0, 0, 1,
      "energy: white metals of roughness 0.05, 0.3, 0.6 and 1 under a uniform sky" },
    { "metal_sphere", metal_sphere_build, 0.3f, 0, -1, "one metal ball; its roughness is free" },
    { "mirror_room", mirror_room_build, 0, 0, -1,
      "a wall of roughness 0.03 shows what is behind the camera" },
    { "brushed_corridor", brushed_corridor_build, 0, 0, -1,
      "metal walls of roughness 0.3 and 0.45, lamps at the far end" },
    { "wet_street_night", wet_street_night_build, 0, 0, -1,
      "puddles on dark asphalt mirror windows, lamps and signs" },
    { "chrome_lamp", chrome_lamp_build, 0, 0, -1, "chrome of roughness 0.02 to 0.2 beside a lamp" },
};

enum { ROW_COUNT = sizeof(rows) / sizeof(rows[0]), NAME_BYTES = 64 };

void scene_flush(struct scene *scene, const char *name, const struct surface *surface)
{
    const struct glb_material material = {
        .name = name,
        .base_color = { surface->albedo.x, surface->albedo.y, surface->albedo.z, 1 },
        .metallic = surface->metallic,
        .roughness = surface->roughness > 0 ? surface->roughness : 1,
        .emission = { surface->emission.x, surface->emission.y, surface->emission.z },
    };
    const glb_handle handle = glb_writer_add_material(scene->writer, &material);
    const struct glb_primitive primitive = mesh_primitive(&scene->mesh, handle, false);
    glb_writer_add_node(scene->writer, name, glb_writer_add_mesh(scene->writer, name, &primitive, 1), NULL);
    const mat4s transform = scene->mesh.transform;
    mesh_finish(&scene->mesh);
    scene->mesh.transform = transform;
}

void scene_shell(struct scene *scene, vec3s low, vec3s high, float thickness, const struct surface *surface)
{
    const vec3s t = v3(thickness, thickness, thickness);
    mesh_room(&scene->mesh, low, high);
    mesh_box(&scene->mesh, glms_vec3_sub(low, t), glms_vec3_add(high, t));
    scene_flush(scene, "shell", surface);
}

void scene_box(struct scene *scene, const char *name, vec3s low, vec3s high, const struct surface *surface)
{
    mesh_box(&scene->mesh, low, high);
    scene_flush(scene, name, surface);
}

void scene_tiles(struct scene *scene, int across, int along, const struct surface *light,
                 const struct surface *dark)
{
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < across * along; i++) {
            const int x = i % across - across / 2, z = i / across - along / 2;
            if ((i % across + i / across) % 2 == pass)
                mesh_box(&scene->mesh, v3((float)x, -0.5f, (float)z), v3((float)(x + 1), 0, (float)(z + 1)));
        }
        scene_flush(scene, pass ? "dark tiles" : "light tiles", pass ? dark : light);
    }
}

void scene_look(struct scene *scene, vec3s position, vec3s look_at, float yfov_deg)
{
    scene->view.position = position;
    scene->view.look_at = look_at;
    scene->view.yfov_deg = yfov_deg;
}

void scene_sky(struct scene *scene, float radiance)
{
    scene->view.has_sky = true;
    scene->view.sky_zenith = scene->view.sky_horizon = scene->view.sky_ground =
        v3(radiance, radiance, radiance);
}

void scene_sun(struct scene *scene, vec3s direction, float irradiance)
{
    scene->view.has_sun = true;
    scene->view.sun_direction = direction;
    scene->view.sun_irradiance = v3(irradiance, irradiance, irradiance);
}

void scene_point_light(struct scene *scene, vec3s position, vec3s color, float intensity)
{
    glb_writer_add_light(scene->writer,
                         &(struct glb_light){ .name = "lamp",
                                              .type = GLB_LIGHT_POINT,
                                              .position = { position.x, position.y, position.z },
                                              .color = { color.x, color.y, color.z },
                                              .intensity = intensity });
}

/* A row to write, or one with another number and a name of its own. */
struct choice {
    const struct scene_row *row;
    float a;
    char name[NAME_BYTES];
};

static bool scene_save(const struct choice *choice, const char *folder, char *error, size_t error_size)
{
    char path[1024];
    struct scene scene = { .writer = glb_writer_create("libsdfgi reference_scenes"),
                           .view = { .lambert = true } };
    if (!scene.writer) {
        snprintf(error, error_size, "out of memory");
        return false;
    }
    mesh_init(&scene.mesh);
    choice->row->build(&scene, choice->a, choice->row->b);
    snprintf(path, sizeof(path), "%s/%s.glb", folder, choice->name);
    bool ok = glb_writer_save(scene.writer, path, error, error_size);
    snprintf(path, sizeof(path), "%s/%s.view.json", folder, choice->name);
    ok = ok && view_save(&scene.view, path, error, error_size);
    mesh_finish(&scene.mesh);
    glb_writer_destroy(scene.writer);
    return ok;
}

static bool list_save(const struct choice *choices, int count, const char *folder, char *error,
                      size_t error_size)
{
    char path[1024];
    cJSON *list = cJSON_CreateArray();
    for (int i = 0; i < count; i++) {
        const struct scene_row *row = choices[i].row;
        cJSON *item = cJSON_CreateObject();
        cJSON_AddStringToObject(item, "name", choices[i].name);
        cJSON_AddStringToObject(item, "shows", row->shows);
        if (row->radiance >= 0)
            cJSON_AddNumberToObject(item, "radiance", row->radiance);
        cJSON_AddItemToArray(list, item);
    }
    char *text = cJSON_Print(list);
    cJSON_Delete(list);
    snprintf(path, sizeof(path), "%s/scenes.json", folder);
    const struct file_part part = { text, text ? strlen(text) : 0 };
    const bool ok = text && file_write_parts(path, &part, 1, error, error_size);
    if (!text)
        snprintf(error, error_size, "%s: out of memory", path);
    cJSON_free(text);
    return ok;
}

static const struct scene_row *row_find(const char *name, size_t length)
{
    for (int i = 0; i < ROW_COUNT; i++)
        if (strlen(rows[i].name) == length && memcmp(rows[i].name, name, length) == 0)
            return &rows[i];
    return NULL;
}

/* NAME, or NAME=ROUGHNESS where a scene has one. */
static bool choice_parse(const char *text, struct choice *choice, char *error, size_t error_size)
{
    const char *number = strchr(text, '=');
    const struct scene_row *row = row_find(text, number ? (size_t)(number - text) : strlen(text));
    if (!row) {
        snprintf(error, error_size, "%s: no such scene; scenes.json lists them", text);
        return false;
    }
    *choice = (struct choice){ .row = row, .a = row->a };
    snprintf(choice->name, sizeof(choice->name), "%s", row->name);
    if (!number)
        return true;
    char *end;
    choice->a = strtof(number + 1, &end);
    if (row->build != metal_sphere_build || end == number + 1 || *end || !(choice->a > 0 && choice->a <= 1) ||
        strlen(text) >= sizeof(choice->name)) {
        snprintf(error, error_size, "%s: expected NAME or metal_sphere=ROUGHNESS in (0, 1]", text);
        return false;
    }
    snprintf(choice->name, sizeof(choice->name), "%s_%s", row->name, number + 1);
    return true;
}

/* The scenes that are named, or all. NULL: one of them is wrong. */
static struct choice *choices_make(char **names, int count, char *error, size_t error_size)
{
    struct choice *choices = calloc((size_t)(count ? count : ROW_COUNT), sizeof(*choices));
    if (!choices)
        snprintf(error, error_size, "out of memory");
    for (int i = 0; choices && i < (count ? count : ROW_COUNT); i++)
        if (!choice_parse(count ? names[i] : rows[i].name, &choices[i], error, error_size)) {
            free(choices);
            return NULL;
        }
    return choices;
}

static int usage(FILE *stream)
{
    fprintf(stream,
            "usage: reference_scenes --out FOLDER [NAME | metal_sphere=ROUGHNESS]...\n"
            "Writes %d small scenes with their views, or those that are named, and scenes.json, which lists\n"
            "them. metal_sphere=0.35 becomes metal_sphere_0.35: the same scene with that roughness.\n",
            ROW_COUNT);
    return stream == stdout ? EXIT_SUCCESS : EXIT_FAILURE;
}

int main(int argc, char **argv)
{
    char error[1200];
    if (argc == 2 && strcmp(argv[1], "--help") == 0)
        return usage(stdout);
    if (argc < 3 || strcmp(argv[1], "--out") != 0)
        return usage(stderr);
    const int count = argc > 3 ? argc - 3 : ROW_COUNT;
    struct choice *choices = choices_make(argv + 3, argc - 3, error, sizeof(error));
    bool ok = choices && file_make_folder(argv[2], error, sizeof(error));
    for (int i = 0; ok && i < count; i++)
        ok = scene_save(&choices[i], argv[2], error, sizeof(error));
    ok = ok && list_save(choices, count, argv[2], error, sizeof(error));
    free(choices);
    if (!ok) {
        fprintf(stderr, "reference_scenes: %s\n", error);
        return EXIT_FAILURE;
    }
    printf("%s: %d scenes\n", argv[2], count);
    return EXIT_SUCCESS;
}

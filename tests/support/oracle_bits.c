/* SPDX-License-Identifier: MIT */
#include "oracle_bits.h"

#include "test_memory.h"

#include <stdlib.h>
#include <string.h>

static size_t bits_word_count(const struct oracle_bits *bits)
{
    return (size_t)bits->size * bits->size * bits->row_words;
}

struct oracle_bits oracle_bits_create(uint32_t size)
{
    struct oracle_bits bits = { .size = size, .row_words = (size + 63) / 64 };
    bits.words = test_array_alloc(bits_word_count(&bits), sizeof *bits.words);
    return bits;
}

struct oracle_bits oracle_bits_random(uint32_t seed, uint32_t size, uint32_t draws)
{
    struct oracle_bits bits = oracle_bits_create(size);
    struct test_random random = { seed };
    for (uint32_t i = 0; i < draws; i++) {
        const uint32_t x = test_random_uint(&random) % size, y = test_random_uint(&random) % size;
        oracle_bits_set(&bits, x, y, test_random_uint(&random) % size);
    }
    return bits;
}

void oracle_bits_destroy(struct oracle_bits *bits)
{
    free(bits->words);
    *bits = (struct oracle_bits){ 0 };
}

void oracle_bits_clear(struct oracle_bits *bits)
{
    memset(bits->words, 0, bits_word_count(bits) * sizeof *bits->words);
}

uint64_t oracle_bits_count(const struct oracle_bits *bits)
{
    uint64_t count = 0;
    for (size_t i = 0; i < bits_word_count(bits); i++)
        count += (uint64_t)__builtin_popcountll(bits->words[i]);
    return count;
}

uint64_t oracle_bits_missing(const struct oracle_bits *superset, const struct oracle_bits *subset,
                             uint32_t first[3])
{
    uint64_t count = 0;
    for (size_t i = 0; i < bits_word_count(subset); i++) {
        const uint64_t lost = subset->words[i] & ~superset->words[i];
        if (lost && !count && first) {
            const size_t row = i / subset->row_words;
            first[0] = (uint32_t)(i % subset->row_words) * 64 + (uint32_t)__builtin_ctzll(lost);
            first[1] = (uint32_t)(row % subset->size);
            first[2] = (uint32_t)(row / subset->size);
        }
        count += (uint64_t)__builtin_popcountll(lost);
    }
    return count;
}

struct oracle_bits oracle_bits_downsample(const struct oracle_bits *bits)
{
    struct oracle_bits half = oracle_bits_create(bits->size / 2);
    for (uint32_t z = 0; z < half.size * 2; z++)
        for (uint32_t y = 0; y < half.size * 2; y++)
            for (uint32_t x = 0; x < half.size * 2; x++)
                if (oracle_bits_get(bits, x, y, z))
                    oracle_bits_set(&half, x / 2, y / 2, z / 2);
    return half;
}

/* ---- Walks: a whole row is filled at once, 64 sub-voxels per operation ---- */

struct row_queue {
    uint32_t *rows; /* ring of row indices; a row is queued at most once at a time, so size^2 slots do */
    bool *queued;
    size_t capacity, head, count;
};

static void row_queue_push(struct row_queue *queue, uint32_t row)
{
    if (queue->queued[row])
        return;
    queue->queued[row] = true;
    queue->rows[(queue->head + queue->count++) % queue->capacity] = row;
}

static uint32_t row_queue_pop(struct row_queue *queue)
{
    const uint32_t row = queue->rows[queue->head];
    queue->head = (queue->head + 1) % queue->capacity;
    queue->count--;
    queue->queued[row] = false;
    return row;
}

/* Spreads `fill` through the set bits of `open`, both ways inside one word (Kogge-Stone). */
static uint64_t word_spread(uint64_t fill, uint64_t open)
{
    uint64_t up = open, down = open;
    for (int shift = 1; shift < 64; shift *= 2) {
        fill |= up & (fill << shift);
        up &= up << shift;
    }
    for (int shift = 1; shift < 64; shift *= 2) {
        fill |= down & (fill >> shift);
        down &= down >> shift;
    }
    return fill;
}

/* Spreads a row's reached bits along x until nothing changes. */
static void row_spread(const struct oracle_bits *bits, uint64_t *reached, const uint64_t *solid,
                       const uint64_t *valid)
{
    for (uint32_t w = 0; w < bits->row_words; w++) {
        const uint64_t carry = w ? reached[w - 1] >> 63 : 0;
        const uint64_t open = ~solid[w] & valid[w];
        reached[w] = word_spread(reached[w] | (carry & open), open);
    }
    for (uint32_t w = bits->row_words; w-- > 0;) {
        const uint64_t carry = w + 1 < bits->row_words ? reached[w + 1] << 63 : 0;
        const uint64_t open = ~solid[w] & valid[w];
        reached[w] = word_spread(reached[w] | (carry & open), open);
    }
}

struct walk {
    const struct oracle_bits *solid;
    struct oracle_bits reached;
    struct row_queue queue;
    uint64_t *valid; /* one row of bits inside the grid */
};

/* Lets the walk step from row `from` into the row at (y, z), which may lie outside the grid. */
static void walk_enter_row(struct walk *walk, uint32_t from, int64_t y, int64_t z)
{
    const uint32_t size = walk->solid->size, words = walk->solid->row_words;
    if (y < 0 || z < 0 || y >= size || z >= size)
        return;
    const uint32_t to = (uint32_t)(y + size * z);
    const uint64_t *source = walk->reached.words + (size_t)from * words;
    const uint64_t *solid = walk->solid->words + (size_t)to * words;
    uint64_t *target = walk->reached.words + (size_t)to * words, grown = 0;
    for (uint32_t w = 0; w < words; w++) {
        const uint64_t entering = source[w] & ~solid[w] & ~target[w];
        target[w] |= entering;
        grown |= entering;
    }
    if (!grown)
        return;
    row_spread(walk->solid, target, solid, walk->valid);
    row_queue_push(&walk->queue, to);
}

static void walk_run(struct walk *walk)
{
    const uint32_t size = walk->solid->size;
    while (walk->queue.count) {
        const uint32_t row = row_queue_pop(&walk->queue);
        const int64_t y = row % size, z = row / size;
        walk_enter_row(walk, row, y - 1, z);
        walk_enter_row(walk, row, y + 1, z);
        walk_enter_row(walk, row, y, z - 1);
        walk_enter_row(walk, row, y, z + 1);
    }
}

struct oracle_bits oracle_bits_walk(const struct oracle_bits *solid, const uint32_t seed[static 3])
{
    struct walk walk = { .solid = solid, .reached = oracle_bits_create(solid->size) };
    if (oracle_bits_get(solid, seed[0], seed[1], seed[2]))
        return walk.reached;
    const size_t row_count = (size_t)solid->size * solid->size;
    walk.queue.capacity = row_count;
    walk.queue.rows = test_array_alloc(row_count, sizeof *walk.queue.rows);
    walk.queue.queued = test_array_alloc(row_count, sizeof *walk.queue.queued);
    walk.valid = test_array_alloc(solid->row_words, sizeof *walk.valid);
    for (uint32_t x = 0; x < solid->size; x++)
        walk.valid[x >> 6] |= UINT64_C(1) << (x & 63);

    oracle_bits_set(&walk.reached, seed[0], seed[1], seed[2]);
    row_spread(solid, oracle_bits_row(&walk.reached, seed[1], seed[2]),
               oracle_bits_row(solid, seed[1], seed[2]), walk.valid);
    row_queue_push(&walk.queue, seed[1] + solid->size * seed[2]);
    walk_run(&walk);
    free(walk.queue.rows);
    free(walk.queue.queued);
    free(walk.valid);
    return walk.reached;
}

static bool row_touches_border(const struct oracle_bits *bits, uint32_t y, uint32_t z)
{
    const uint64_t *row = oracle_bits_row(bits, y, z);
    if (y > 0 && z > 0 && y + 1 < bits->size && z + 1 < bits->size)
        return oracle_bits_get(bits, 0, y, z) || oracle_bits_get(bits, bits->size - 1, y, z);
    for (uint32_t w = 0; w < bits->row_words; w++)
        if (row[w])
            return true;
    return false;
}

bool oracle_bits_walk_escapes(const struct oracle_bits *solid, const uint32_t seed[static 3],
                              uint64_t *reached)
{
    struct oracle_bits walk = oracle_bits_walk(solid, seed);
    bool escapes = false;
    for (uint32_t z = 0; z < walk.size && !escapes; z++)
        for (uint32_t y = 0; y < walk.size && !escapes; y++)
            escapes = row_touches_border(&walk, y, z);
    if (reached)
        *reached = oracle_bits_count(&walk);
    oracle_bits_destroy(&walk);
    return escapes;
}

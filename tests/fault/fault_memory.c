/* SPDX-License-Identifier: MIT
 * malloc and its kin, for calls from the program, the library and the libraries that read and write files for
 * them; not for those of the loader, of drivers, and of this. What the C and C++ libraries allocate is
 * counted for who called them. */
#define _GNU_SOURCE
#include "fault.h"

#include <errno.h>
#include <link.h>
#include <stdlib.h>
#include <string.h>
#include <unwind.h>

extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
extern void *__libc_realloc(void *memory, size_t size);
extern void *__libc_memalign(size_t alignment, size_t size);
extern void __libc_free(void *memory);

/* ---- Whose code -------------------------------------------------------------------------------------- */

enum module_kind { MODULE_FOREIGN, MODULE_PASSES_ON, MODULE_COUNTED };

static const struct {
    const char *name;
    enum module_kind kind;
} module_names[] = {
    { "/libsdfgi.so", MODULE_COUNTED },    { "/libtinygltf.so", MODULE_COUNTED },
    { "/libcjson.so", MODULE_COUNTED },    { "/libpng16.so", MODULE_COUNTED },
    { "/libstb.so", MODULE_COUNTED },      { "/libOpenEXRCore", MODULE_COUNTED },
    { "/libz.so", MODULE_COUNTED },        { "/libc.so", MODULE_PASSES_ON },
    { "/libstdc++.so", MODULE_PASSES_ON }, { "/libfault_", MODULE_PASSES_ON }, /* this */
};

enum { MODULES_MAX = 64 };

static struct module {
    uintptr_t begin, end;
    enum module_kind kind;
} modules[MODULES_MAX];
static uint32_t module_count;

static enum module_kind kind_of(const char *name)
{
    if (!name[0])
        return MODULE_COUNTED; /* the program */
    for (size_t i = 0; i < sizeof module_names / sizeof *module_names; i++)
        if (strstr(name, module_names[i].name))
            return module_names[i].kind;
    return MODULE_FOREIGN;
}

static int add_module(struct dl_phdr_info *info, size_t size, void *user)
{
    (void)size;
    (void)user;
    const enum module_kind kind = kind_of(info->dlpi_name);
    for (int i = 0; i < info->dlpi_phnum && kind != MODULE_FOREIGN && module_count < MODULES_MAX; i++) {
        const ElfW(Phdr) *const part = &info->dlpi_phdr[i];
        const uintptr_t begin = info->dlpi_addr + part->p_vaddr;
        if (part->p_type == PT_LOAD && (part->p_flags & PF_X))
            modules[module_count++] = (struct module){ begin, begin + part->p_memsz, kind };
    }
    return 0;
}

__attribute__((constructor)) static void find_modules(void)
{
    dl_iterate_phdr(add_module, NULL);
}

static const struct module *module_at(uintptr_t address)
{
    for (uint32_t i = 0; i < module_count; i++)
        if (address >= modules[i].begin && address < modules[i].end)
            return &modules[i];
    return NULL;
}

/* ---- Where from -------------------------------------------------------------------------------------- */

enum { SITE_FRAMES = 3 };

struct walk {
    bool counted;
    uint32_t frames;
    uint64_t site;
};

/* From the first frame behind malloc on: those of the C and C++ libraries, then the one that counts. Some of
 * its callers tell calls of a common helper apart. */
static _Unwind_Reason_Code walk_frame(struct _Unwind_Context *context, void *user)
{
    struct walk *walk = user;
    const uintptr_t address = _Unwind_GetIP(context);
    const struct module *module = module_at(address);
    if (!walk->counted && (!module || module->kind != MODULE_COUNTED))
        return module ? _URC_NO_REASON : _URC_END_OF_STACK;
    walk->counted = true;
    walk->site = walk->site * 1000003 + (module ? address - module->begin : 0);
    return ++walk->frames < SITE_FRAMES ? _URC_NO_REASON : _URC_END_OF_STACK;
}

/* Whether the call that returns to `caller` counts, and from where it came. */
static bool counts(const void *caller, uint64_t *site)
{
    static __thread bool inside __attribute__((tls_model("initial-exec")));
    const struct module *module = module_at((uintptr_t)caller);
    struct walk walk = { .counted = false };
    if (!module || inside)
        return false;
    inside = true;
    _Unwind_Backtrace(walk_frame, &walk);
    inside = false;
    *site = walk.site;
    return walk.counted;
}

/* ---- What lives -------------------------------------------------------------------------------------- */

/* More than a run has calls. A larger table takes longer: what a process touches first is a page fault. */
enum { SLOT_BITS = 14, SLOTS = 1 << SLOT_BITS };

static struct {
    void *memory;
    uint64_t site;
} living[SLOTS];
static uint32_t living_count;
static char lock;

static void *const removed = (void *)1;

static uint32_t slot_of(const void *memory)
{
    return (uint32_t)(((uintptr_t)memory >> 4) * UINT64_C(0x9e3779b97f4a7c15) >> (64 - SLOT_BITS));
}

static void take_lock(void)
{
    while (__atomic_test_and_set(&lock, __ATOMIC_ACQUIRE))
        ;
}

static void add(void *memory, uint64_t site)
{
    if (!memory)
        return;
    take_lock();
    uint32_t slot = slot_of(memory);
    while (living[slot].memory && living[slot].memory != removed)
        slot = (slot + 1) % SLOTS;
    living[slot].memory = memory;
    living[slot].site = site;
    living_count++;
    __atomic_clear(&lock, __ATOMIC_RELEASE);
}

static void drop(const void *memory)
{
    if (!memory || living_count == 0)
        return;
    take_lock();
    uint32_t slot = slot_of(memory);
    while (living[slot].memory && living[slot].memory != memory)
        slot = (slot + 1) % SLOTS;
    if (living[slot].memory) {
        living[slot].memory = removed;
        living_count--;
    }
    __atomic_clear(&lock, __ATOMIC_RELEASE);
}

void fault_memory_report(FILE *out)
{
    for (uint32_t i = 0; i < SLOTS && living_count > 0; i++)
        if (living[i].memory && living[i].memory != removed)
            fprintf(out, "leak allocation %llx\n", (unsigned long long)living[i].site);
}

/* ---- The functions ----------------------------------------------------------------------------------- */

/* Fails, or gives what `allocate` gives. */
#define ALLOCATE(size, allocate)                                                                             \
    uint64_t site = 0;                                                                                       \
    const bool counted = counts(__builtin_return_address(0), &site);                                         \
    if (counted && fault_allocation(site, size)) {                                                           \
        errno = ENOMEM;                                                                                      \
        return NULL;                                                                                         \
    }                                                                                                        \
    void *const result = allocate;                                                                           \
    if (counted)                                                                                             \
        add(result, site);                                                                                   \
    return result

void *malloc(size_t size)
{
    ALLOCATE(size, __libc_malloc(size));
}

void *calloc(size_t count, size_t size)
{
    ALLOCATE(count * size, __libc_calloc(count, size));
}

void *aligned_alloc(size_t alignment, size_t size)
{
    ALLOCATE(size, __libc_memalign(alignment, size));
}

void *realloc(void *memory, size_t size)
{
    uint64_t site = 0;
    const bool counted = counts(__builtin_return_address(0), &site);
    if (counted && size > 0 && fault_allocation(site, size)) {
        errno = ENOMEM;
        return NULL;
    }
    drop(memory);
    void *const result = __libc_realloc(memory, size);
    if (counted)
        add(result ? result : size > 0 ? memory : NULL, site);
    return result;
}

int posix_memalign(void **out, size_t alignment, size_t size)
{
    uint64_t site = 0;
    const bool counted = counts(__builtin_return_address(0), &site);
    if (counted && fault_allocation(site, size))
        return ENOMEM;
    *out = __libc_memalign(alignment, size);
    if (counted)
        add(*out, site);
    return *out ? 0 : ENOMEM;
}

void free(void *memory)
{
    drop(memory);
    __libc_free(memory);
}

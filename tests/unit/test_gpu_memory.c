/* SPDX-License-Identifier: MIT
 *
 * Which memory type a buffer gets, on devices made of memory types alone. */
#include "unit.h"

#include <gpu.h>

enum {
    LOCAL = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT,
    VISIBLE = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT,
    COHERENT = VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
    CACHED = VK_MEMORY_PROPERTY_HOST_CACHED_BIT,
    VENDOR = VK_MEMORY_PROPERTY_DEVICE_COHERENT_BIT_AMD, /* only with a feature that is not switched on */
};

struct fake {
    uint32_t allowed;     /* memory types that suit the buffer */
    uint32_t chosen;      /* that it was given */
    uint32_t invalidated; /* times */
    VkDeviceSize size;    /* of the buffer */
};
static struct fake fake;

static VkResult create_buffer(VkDevice device, const VkBufferCreateInfo *info,
                              const VkAllocationCallbacks *callbacks, VkBuffer *buffer)
{
    (void)device, (void)callbacks;
    fake.size = info->size;
    *buffer = VK_NULL_HANDLE;
    return VK_SUCCESS;
}

static void get_requirements(VkDevice device, VkBuffer buffer, VkMemoryRequirements *needs)
{
    (void)device, (void)buffer;
    *needs = (VkMemoryRequirements){ 64, 64, fake.allowed };
}

static VkResult allocate(VkDevice device, const VkMemoryAllocateInfo *info,
                         const VkAllocationCallbacks *callbacks, VkDeviceMemory *memory)
{
    (void)device, (void)callbacks;
    fake.chosen = info->memoryTypeIndex;
    *memory = VK_NULL_HANDLE;
    return VK_SUCCESS;
}

static VkResult bind(VkDevice device, VkBuffer buffer, VkDeviceMemory memory, VkDeviceSize offset)
{
    (void)device, (void)buffer, (void)memory, (void)offset;
    return VK_SUCCESS;
}

static VkResult map(VkDevice device, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize size,
                    VkMemoryMapFlags flags, void **data)
{
    (void)device, (void)memory, (void)offset, (void)size, (void)flags;
    *data = &fake;
    return VK_SUCCESS;
}

static VkResult invalidate(VkDevice device, uint32_t count, const VkMappedMemoryRange *ranges)
{
    (void)device, (void)count, (void)ranges;
    fake.invalidated++;
    return VK_SUCCESS;
}

static void destroy_buffer(VkDevice device, VkBuffer buffer, const VkAllocationCallbacks *callbacks)
{
    (void)device, (void)buffer, (void)callbacks;
}

static void free_memory(VkDevice device, VkDeviceMemory memory, const VkAllocationCallbacks *callbacks)
{
    (void)device, (void)memory, (void)callbacks;
}

static const VkMemoryPropertyFlags many[] = {
    LOCAL,          VISIBLE | COHERENT,         LOCAL | VISIBLE | COHERENT, VISIBLE | COHERENT | CACHED,
    LOCAL | VENDOR, VISIBLE | COHERENT | VENDOR
};
static const VkMemoryPropertyFlags incoherent[] = { LOCAL, VISIBLE | CACHED };

static struct gpu_device device_make(const VkMemoryPropertyFlags *types, uint32_t count)
{
    struct gpu_device device = { .fn = { .CreateBuffer = create_buffer,
                                         .GetBufferMemoryRequirements = get_requirements,
                                         .AllocateMemory = allocate,
                                         .BindBufferMemory = bind,
                                         .MapMemory = map,
                                         .InvalidateMappedMemoryRanges = invalidate,
                                         .DestroyBuffer = destroy_buffer,
                                         .FreeMemory = free_memory } };
    device.memory.memoryTypeCount = count;
    for (uint32_t i = 0; i < count; i++)
        device.memory.memoryTypes[i].propertyFlags = types[i];
    return device;
}

static uint32_t chosen_for(uint32_t allowed, enum gpu_placement placement)
{
    const struct gpu_device device = device_make(many, sizeof many / sizeof *many);
    struct gpu_buffer buffer;
    fake = (struct fake){ .allowed = allowed, .chosen = UINT32_MAX };
    const VkResult result = gpu_buffer_init(&device, &buffer, 64, 0, placement, 0, "buffer");
    assert_int_equal(result, fake.chosen == UINT32_MAX ? VK_ERROR_OUT_OF_DEVICE_MEMORY : VK_SUCCESS);
    return fake.chosen;
}

static void the_first_type_with_all_that_is_wanted_is_taken(void **state)
{
    (void)state;
    assert_int_equal(chosen_for(0x3f, GPU_DEVICE_LOCAL), 0);
    assert_int_equal(chosen_for(0x3e, GPU_DEVICE_LOCAL), 2);
    assert_int_equal(chosen_for(0x3f, GPU_HOST_READ), 3);
}

static void without_it_the_first_that_will_do_is_taken(void **state)
{
    (void)state;
    assert_int_equal(chosen_for(0x2a, GPU_DEVICE_LOCAL), 1);
    assert_int_equal(chosen_for(0x37, GPU_HOST_READ), 1);
}

static void without_any_the_buffer_is_refused(void **state)
{
    (void)state;
    assert_int_equal(chosen_for(0x11, GPU_HOST_READ), UINT32_MAX);
    assert_int_equal(chosen_for(0, GPU_DEVICE_LOCAL), UINT32_MAX);
}

static void memory_that_is_not_coherent_is_invalidated(void **state)
{
    (void)state;
    const struct gpu_device device = device_make(incoherent, 2);
    struct gpu_buffer buffer;
    fake = (struct fake){ .allowed = 3 };
    assert_int_equal(gpu_buffer_init(&device, &buffer, 64, 0, GPU_HOST_READ, 0, "buffer"), VK_SUCCESS);
    assert_int_equal(gpu_buffer_invalidate(&device, &buffer), VK_SUCCESS);
    assert_int_equal(fake.invalidated, 1);
}

static VkDeviceSize made_for(uint64_t size, VkBufferUsageFlags usage)
{
    const struct gpu_device device = device_make(many, 6);
    struct gpu_buffer buffer;
    fake = (struct fake){ .allowed = 0x3f };
    assert_int_equal(gpu_buffer_init(&device, &buffer, size, usage, GPU_DEVICE_LOCAL, 0, "buffer"),
                     VK_SUCCESS);
    assert_int_equal(buffer.size, size);
    return fake.size;
}

/* A driver that tells these sizes apart compiles every shader again that reads the buffer. */
static void buffers_of_texels_have_sizes_of_one_kind(void **state)
{
    (void)state;
    static const uint64_t sizes[] = { 4, 96, 256, 4096, 1 << 20, (1 << 20) + 256, 3 << 16, 3 << 20, 12345 };
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        const VkDeviceSize made = made_for(sizes[i], VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
        assert_true(made >= sizes[i] && made <= sizes[i] + 512);
        assert_true((made & (made - 1)) != 0 && (made >> 8 & 0xff) != 0);
        assert_int_equal(made_for(sizes[i], VK_BUFFER_USAGE_STORAGE_BUFFER_BIT), sizes[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_type_with_all_that_is_wanted_is_taken),
        cmocka_unit_test(without_it_the_first_that_will_do_is_taken),
        cmocka_unit_test(without_any_the_buffer_is_refused),
        cmocka_unit_test(memory_that_is_not_coherent_is_invalidated),
        cmocka_unit_test(buffers_of_texels_have_sizes_of_one_kind),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#include "failing_memory.hpp"

#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace test::memory {

bool armed = false, lasting = false, everywhere = false, fired = false;
long left = 0, failures = 0, live = 0, live_new = 0;

} // namespace test::memory

using namespace test::memory;

namespace {

thread_local bool inside_new = false; // MPI has threads of its own

bool fails() {
    if (!armed || !(everywhere || inside_new))
        return false;
    if (fired ? !lasting : left-- > 0)
        return false;
    fired = true;
    ++failures;
    errno = ENOMEM;
    return true;
}

void *counted(void *memory) {
    live += memory != nullptr;
    return memory;
}

} // namespace

extern "C" {
void *__libc_malloc(size_t);
void *__libc_calloc(size_t, size_t);
void *__libc_realloc(void *, size_t);
void *__libc_memalign(size_t, size_t);
void __libc_free(void *);

void *malloc(size_t size) {
    return fails() ? nullptr : counted(__libc_malloc(size));
}
void *calloc(size_t n, size_t size) {
    return fails() ? nullptr : counted(__libc_calloc(n, size));
}
void *realloc(void *memory, size_t size) {
    if (fails())
        return nullptr;
    void *const moved = __libc_realloc(memory, size);
    live += (moved != nullptr) - (memory != nullptr && (moved != nullptr || size == 0));
    return moved;
}
void *aligned_alloc(size_t alignment, size_t size) {
    return fails() ? nullptr : counted(__libc_memalign(alignment, size));
}
void *memalign(size_t alignment, size_t size) {
    return aligned_alloc(alignment, size);
}
int posix_memalign(void **memory, size_t alignment, size_t size) {
    void *const found = aligned_alloc(alignment, size);
    if (!found)
        return ENOMEM;
    *memory = found;
    return 0;
}
void free(void *memory) {
    live -= memory != nullptr;
    __libc_free(memory);
}
}

#define REPLACED [[gnu::noinline]]

namespace {
void *allocate(std::size_t size, std::size_t alignment) {
    inside_new = true;
    void *const memory =
        alignment > alignof(std::max_align_t) ? aligned_alloc(alignment, size) : malloc(size ? size : 1);
    inside_new = false;
    if (!memory)
        throw std::bad_alloc();
    ++live_new;
    return memory;
}
void release(void *memory) {
    live_new -= memory != nullptr;
    free(memory);
}
} // namespace

// clang-format off
REPLACED void *operator new(std::size_t size) { return allocate(size, 1); }
REPLACED void *operator new(std::size_t size, std::align_val_t a) { return allocate(size, static_cast<std::size_t>(a)); }
REPLACED void operator delete(void *memory) noexcept { release(memory); }
REPLACED void operator delete(void *memory, std::size_t) noexcept { release(memory); }
REPLACED void operator delete(void *memory, std::align_val_t) noexcept { release(memory); }
REPLACED void operator delete(void *memory, std::size_t, std::align_val_t) noexcept { release(memory); }
// clang-format on

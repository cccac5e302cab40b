#include "numerics/huge_pages.h"

#ifdef __linux__
#include <sys/mman.h>

#include <cstdint>
#endif

namespace skinglow::detail {

void advise_huge_pages([[maybe_unused]] void* begin, [[maybe_unused]] std::size_t bytes) {
#ifdef __linux__
    constexpr std::size_t huge_page = std::size_t{2} << 20U;
    const auto address = reinterpret_cast<std::uintptr_t>(begin);
    const std::size_t before = (huge_page - address % huge_page) % huge_page;  // none of a neighbor's
    if (bytes < before + huge_page) return;
    ::madvise(static_cast<char*>(begin) + before, (bytes - before) / huge_page * huge_page, MADV_HUGEPAGE);
#endif
}

}  // namespace skinglow::detail

#pragma once

#include <cstddef>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Asks the system to back memory that was not written to yet by large pages, where it has them: of a mesh of a
/// million triangles that is read, half of the time goes into handing out small ones. A wish, never an error.
void advise_huge_pages(void* begin, std::size_t bytes);

/// Room for so many entries, at least twice what there was, on large pages.
template <class Container>
void reserve_huge(Container& container, std::size_t count) {
    if (count <= container.capacity()) return;
    container.reserve(count < 2 * container.capacity() ? 2 * container.capacity() : count);
    advise_huge_pages(container.data() + container.size(),
                      (container.capacity() - container.size()) * sizeof(*container.data()));
}

}  // namespace skinglow::detail

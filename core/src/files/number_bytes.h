#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "numerics/detail.h"

/// Numbers in binary files, one at a time or many.
namespace skinglow::detail {

/// An index that no vertex has.
constexpr std::uint32_t no_index = 0xFFFFFFFF;

template <class Number, bool big_endian>
Number raw_number(const char* bytes) {
    std::array<char, sizeof(Number)> raw{};
    std::memcpy(raw.data(), bytes, raw.size());
    if constexpr (big_endian != (std::endian::native == std::endian::big))
        std::reverse(raw.begin(), raw.end());
    return std::bit_cast<Number>(raw);
}

/// The 32 bits at an offset, least significant byte first.
inline std::uint32_t word_at(std::string_view bytes, std::size_t offset) {
    return raw_number<std::uint32_t, false>(bytes.data() + offset);
}

/// A number from its bytes in a file, whatever the machine's own byte order.
template <class Number, bool big_endian>
double load_number(const char* bytes) {
    return static_cast<double>(raw_number<Number, big_endian>(bytes));
}

/// As a double, or as an index: what is none, such as -1, becomes one that no mesh has.
template <class Out, class Number>
Out converted(Number number) {
    if constexpr (std::floating_point<Number> && std::same_as<Out, std::uint32_t>) {
        return number >= Number(0) && number < Number(no_index) ? static_cast<std::uint32_t>(number)
                                                                : no_index;
    } else {
        return static_cast<Out>(number);
    }
}

/// `count` numbers that are `stride` bytes apart, to positions `out_stride` apart.
template <class Number, bool big_endian, class Out>
void load_numbers(const char* first, std::size_t stride, std::size_t count, Out* out,
                  std::size_t out_stride) {
    if (stride == sizeof(Number) && out_stride == 1) {  // compilers make vector code of this
        for (std::size_t i = 0; i < count; ++i)
            out[i] = converted<Out>(raw_number<Number, big_endian>(first + i * sizeof(Number)));
        return;
    }
    for (std::size_t i = 0; i < count; ++i)
        out[i * out_stride] = converted<Out>(raw_number<Number, big_endian>(first + i * stride));
}

/// How a type of numbers in files is read.
struct NumberType {
    std::size_t size = 0;  ///< bytes
    double (*load)(const char* bytes) = nullptr;
    void (*load_doubles)(const char* first, std::size_t stride, std::size_t count, double* out,
                         std::size_t out_stride) = nullptr;
    void (*load_indices)(const char* first, std::size_t stride, std::size_t count, std::uint32_t* out,
                         std::size_t out_stride) = nullptr;
};

template <class Number, bool big_endian>
constexpr NumberType number_type = {sizeof(Number), load_number<Number, big_endian>,
                                    load_numbers<Number, big_endian, double>,
                                    load_numbers<Number, big_endian, std::uint32_t>};

}  // namespace skinglow::detail

#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "numerics/detail.h"

namespace skinglow::detail {

/// A sparse matrix by rows. One column index serves the entries of all nodes.
template <typename Value>
class SparseRows {
  public:
    std::size_t rows() const { return begin_.size() - 1; }
    std::size_t entries() const { return column_.size(); }
    std::size_t bytes() const {
        return begin_.size() * sizeof(std::uint32_t) +
               column_.size() * (sizeof(std::uint32_t) + sizeof(Value));
    }

    void add(std::uint32_t column, const Value& value) {
        column_.push_back(column);
        value_.push_back(value);
    }
    void end_row() { begin_.push_back(static_cast<std::uint32_t>(column_.size())); }

    /// Memory for rows and entries that will be appended, so that none of it is held twice while they are.
    void reserve(std::size_t rows, std::size_t entries) {
        begin_.reserve(rows + 1);
        column_.reserve(entries);
        value_.reserve(entries);
    }

    /// Rows of another matrix after those that are here.
    void append(const SparseRows& other) {
        const std::uint32_t shift = begin_.back();
        for (std::size_t i = 1; i < other.begin_.size(); ++i) begin_.push_back(other.begin_[i] + shift);
        column_.insert(column_.end(), other.column_.begin(), other.column_.end());
        value_.insert(value_.end(), other.value_.begin(), other.value_.end());
    }

    void shrink() {
        column_.shrink_to_fit();
        value_.shrink_to_fit();
    }

    std::span<const std::uint32_t> columns(std::size_t row) const {
        return {column_.data() + begin_[row], begin_[row + 1] - begin_[row]};
    }
    std::span<const Value> values(std::size_t row) const {
        return {value_.data() + begin_[row], begin_[row + 1] - begin_[row]};
    }
    const std::vector<std::uint32_t>& all_columns() const { return column_; }
    /// Columns that have an entry, ascending.
    std::vector<std::uint32_t> used_columns() const {
        std::vector<std::uint32_t> used = column_;
        std::sort(used.begin(), used.end());
        used.erase(std::unique(used.begin(), used.end()), used.end());
        return used;
    }

  private:
    std::vector<std::uint32_t> begin_{0};
    std::vector<std::uint32_t> column_;
    std::vector<Value> value_;
};

/// Sums of one row while it grows, by column. Kept between rows: a row costs its entries, not its width.
template <typename Value>
class RowSums {
  public:
    explicit RowSums(std::size_t columns) : sum_(columns), seen_(columns, 0) {}

    Value& at(std::uint32_t column) {
        if (seen_[column] == 0) {
            seen_[column] = 1;
            touched_.push_back(column);
        }
        return sum_[column];
    }

    /// Calls `use(column, sum)` by ascending column and forgets the row.
    template <typename Use>
    void take(const Use& use) {
        std::sort(touched_.begin(), touched_.end());
        for (const std::uint32_t column : touched_) {
            use(column, sum_[column]);
            sum_[column] = Value{};
            seen_[column] = 0;
        }
        touched_.clear();
    }

  private:
    std::vector<Value> sum_;
    std::vector<std::uint8_t> seen_;
    std::vector<std::uint32_t> touched_;
};

}  // namespace skinglow::detail

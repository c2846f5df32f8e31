#pragma once

#include "results/results.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

/// The one description of every table. Writing, reading and the check of README.md all follow it:
/// a new column is one line in main_tables.cpp or figure_tables.cpp (and the member it names).
namespace boxwood::results {

inline constexpr std::string_view format_name = "boxwood-results";
inline constexpr std::uint32_t schema_major = 2, schema_minor = 4;

/// Bytes of a column that holds an enum's word.
inline constexpr std::size_t word_width = 32;

/// How the values of a column stand in the file. An enum's word is a text there.
enum class Stored : std::uint8_t { uint32, uint64, real, text };

/// One column of a table. A row is given by its first byte.
struct Column {
    std::string_view name, unit, summary;
    std::size_t width = 0;   ///< bytes of a text in the file; a longer one is an error, never cut
    bool is_derived = false; ///< by bench/analysis, in a table that is measured
    std::uint32_t minor = 0; ///< since this minor version; older files lack it
    Stored stored = Stored::text;
    std::span<const std::string_view> words; ///< of an enum, else none
    std::size_t at = 0, size = 0;            ///< of the member in its row, in bytes

    template <class Value> const Value& value(const std::byte* row) const {
        return *reinterpret_cast<const Value*>(row + at);
    }
    template <class Value> Value& value(std::byte* row) const {
        return *reinterpret_cast<Value*>(row + at);
    }
    /// Of a text: what stands in the file. False for a word that is not one of them.
    std::string_view text(const std::byte* row) const;
    bool set_text(std::byte* row, std::string_view text) const;
};

/// A column of the member of a `Row`.
template <class Row> struct ColumnOf : Column {
    template <class Value>
    ColumnOf(std::string_view name_, Value Row::*member, std::string_view unit_,
             std::string_view summary_, std::size_t width_ = 0, bool is_derived_ = false,
             std::uint32_t minor_ = 0) {
        name = name_;
        unit = unit_;
        summary = summary_;
        width = width_;
        is_derived = is_derived_;
        minor = minor_;
        const Row row{};
        at = static_cast<std::size_t>(reinterpret_cast<const std::byte*>(&(row.*member)) -
                                      reinterpret_cast<const std::byte*>(&row));
        size = sizeof(Value);
        if constexpr (Worded<Value>) {
            static_assert(sizeof(Value) == 1);
            words = Words<Value>::all;
            width = word_width;
        } else if constexpr (std::is_same_v<Value, std::uint32_t>) {
            stored = Stored::uint32;
        } else if constexpr (std::is_same_v<Value, std::uint64_t>) {
            stored = Stored::uint64;
        } else if constexpr (std::is_same_v<Value, double>) {
            stored = Stored::real;
        } else {
            static_assert(std::is_same_v<Value, std::string>);
        }
    }
};

/// The rows of a table, whatever their type.
template <class Byte> struct Rows {
    Byte* first;
    std::size_t n, row_size;

    Byte* operator[](std::size_t i) const { return first + i * row_size; }
};

/// One compound dataset of the file.
class Table {
  public:
    template <class Row>
    Table(std::string_view name_, std::string_view summary_, std::vector<Row> Results::*rows,
          std::initializer_list<ColumnOf<std::type_identity_t<Row>>> columns_,
          bool is_derived_ = false, std::uint32_t minor_ = 0)
        : name(name_), summary(summary_), columns(columns_.begin(), columns_.end()),
          is_derived(is_derived_), minor(minor_), row_size(sizeof(Row)),
          rows_([rows](Results& results) {
              std::vector<Row>& all = results.*rows;
              return Rows<std::byte>{reinterpret_cast<std::byte*>(all.data()), all.size(),
                                     sizeof(Row)};
          }),
          resize_([rows](Results& results, std::size_t n) { (results.*rows).resize(n); }) {}

    std::string_view name, summary;
    std::vector<Column> columns;
    bool is_derived;     ///< from the others, by bench/analysis
    std::uint32_t minor; ///< since this minor version
    std::size_t row_size;

    Rows<std::byte> rows(Results& results) const { return rows_(results); }
    Rows<const std::byte> rows(const Results& results) const {
        const auto [first, n, size] = rows_(const_cast<Results&>(results)); // not written to
        return {first, n, size};
    }
    void resize(Results& results, std::size_t n) const { resize_(results, n); }

  private:
    std::function<Rows<std::byte>(Results&)> rows_;
    std::function<void(Results&, std::size_t)> resize_;
};

/// Columns that hold the id of a row of a table, wherever they stand. In a derived table no_id
/// stands for none.
struct Reference {
    std::string_view column, table;
};
inline constexpr Reference references[] = {
    {"env_id", "env"},          {"scene_id", "scenes"},    {"variant_id", "variants"},
    {"cell_id", "cells"},       {"shard_id", "shards"},    {"cell_a", "cells"},
    {"cell_b", "cells"},        {"ours", "cells"},         {"rival", "cells"},
    {"ours_alone", "cells"},    {"rival_alone", "cells"},  {"fresh_cell", "cells"},
    {"cell_with", "cells"},     {"cell_without", "cells"}, {"cell_1", "cells"},
    {"cell_2", "cells"},        {"cell_all", "cells"},     {"cell_device", "cells"},
    {"cell_resident", "cells"}, {"cell_graph", "cells"},   {"cell_cpu", "cells"}};

/// Every table, in the order of results.h.
const std::vector<Table>& tables();
/// Their two parts: what was measured and found, and what figures show.
std::vector<Table> main_tables();
std::vector<Table> figure_tables();

} // namespace boxwood::results

#pragma once

#include "results/results.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <variant>
#include <vector>

/// The one description of every table. Writing, reading and the check of README.md all follow it:
/// a new column is one line in schema.cpp (and the member it names).
namespace boxwood::results {

inline constexpr std::string_view format_name = "boxwood-results";
inline constexpr std::uint32_t schema_major = 2, schema_minor = 0;

/// Bytes of a column that holds an enum's word.
inline constexpr std::size_t word_width = 32;

/// One column of a table of `Row`s.
template <class Row> struct Column {
    std::string_view name;
    std::variant<std::uint32_t Row::*, std::uint64_t Row::*, double Row::*, std::string Row::*,
                 Phase Row::*, Status Row::*, Verdict Row::*, Reason Row::*, Family Row::*,
                 Topic Row::*>
        member;
    std::string_view unit, summary;
    std::size_t width = 0; ///< bytes of a string; a longer one is an error, never cut
};

/// How the values of a column stand in the file.
enum class Stored : std::uint8_t { uint32, uint64, real, text };
template <class Value>
inline constexpr Stored stored_as = std::is_same_v<Value, std::uint32_t>   ? Stored::uint32
                                    : std::is_same_v<Value, std::uint64_t> ? Stored::uint64
                                    : std::is_same_v<Value, double>        ? Stored::real
                                                                           : Stored::text;
template <class Row> Stored stored(const Column<Row>& column) {
    return std::visit([]<class Value>(Value Row::*) { return stored_as<Value>; }, column.member);
}

/// One compound dataset of the file.
template <class Row> struct Table {
    std::string_view name, summary;
    std::vector<Row> Results::*rows;
    std::vector<Column<Row>> columns;
};

using Tables = std::tuple<Table<Env>, Table<Package>, Table<SceneRow>, Table<Variant>, Table<Cell>,
                          Table<Shard>, Table<Sample>, Table<FrameRow>, Table<EffectRow>,
                          Table<Counter>, Table<Check>, Table<TreeRow>, Table<KernelRow>,
                          Table<ConditionRow>, Table<Median>, Table<Comparison>, Table<SizeScaling>,
                          Table<BreakEven>, Table<KernelCost>, Table<Finding>, Table<Health>>;
const Tables& tables();

/// Calls visit(table) for every table, in the order of results.h.
template <class Visit> void for_each_table(Visit&& visit) {
    std::apply([&](const auto&... table) { (visit(table), ...); }, tables());
}

} // namespace boxwood::results

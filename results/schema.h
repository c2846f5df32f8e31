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
    std::size_t width = 0;   ///< bytes of a string; a longer one is an error, never cut
    bool is_derived = false; ///< by bench/analysis, in a table that is measured
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
    bool is_derived = false; ///< from the others, by bench/analysis
};

/// Columns that hold the id of a row of a table, wherever they stand. In a derived table no_id
/// stands for none.
struct Reference {
    std::string_view column, table;
};
inline constexpr Reference references[] = {
    {"env_id", "env"},       {"scene_id", "scenes"},   {"variant_id", "variants"},
    {"cell_id", "cells"},    {"shard_id", "shards"},   {"cell_a", "cells"},
    {"cell_b", "cells"},     {"ours", "cells"},        {"rival", "cells"},
    {"ours_alone", "cells"}, {"rival_alone", "cells"}, {"fresh_cell", "cells"},
    {"cell_with", "cells"},  {"cell_without", "cells"}};

using MainTables =
    std::tuple<Table<Env>, Table<Package>, Table<SceneRow>, Table<TaskRow>, Table<Variant>,
               Table<Cell>, Table<Shard>, Table<Sample>, Table<FrameRow>, Table<EffectRow>,
               Table<Counter>, Table<Check>, Table<TreeRow>, Table<KernelRow>, Table<ConditionRow>,
               Table<Median>, Table<Comparison>, Table<SizeScaling>, Table<BreakEven>,
               Table<KernelCost>, Table<TopicRow>, Table<Finding>, Table<Health>>;
using FigureTables = std::tuple<Table<FrameMedian>, Table<FrameStats>, Table<StageCost>,
                                Table<EffectCost>, Table<KernelCondition>, Table<Escalation>,
                                Table<QueryKernel>, Table<WorkRow>, Table<Drift>>;
using Tables = decltype(std::tuple_cat(MainTables(), FigureTables()));
const FigureTables& figure_tables();
const Tables& tables();

/// Calls visit(table) for every table, in the order of results.h.
template <class Visit> void for_each_table(Visit&& visit) {
    std::apply([&](const auto&... table) { (visit(table), ...); }, tables());
}

} // namespace boxwood::results

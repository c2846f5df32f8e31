#pragma once

#include "results/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <iterator>
#include <string>
#include <type_traits>

namespace boxwood::results {

/// Fills every column of every table, whatever columns there are, with values of its own; ids are
/// the numbers of the rows.
inline Results filled_example(std::size_t rows_per_table = 3) {
    Results results;
    results.run_uuid = "6a5b3c1e-0000-4000-8000-000000000001";
    results.created_utc = "2024-05-06T07:08:09Z";
    results.sweep_hash = "abcdef";
    results.generator = "boxwood test";
    results.texts = {{"argv", "boxwood sweep"}, {"lscpu", "Modell: \u00e4\n"}, {"empty", ""}};
    std::uint64_t next = 1;
    for_each_table([&]<class Row>(const Table<Row>& table) {
        auto& rows = results.*table.rows;
        rows.resize(rows_per_table);
        for (Row& row : rows)
            for (const auto& column : table.columns) {
                if (std::ranges::find(references, column.name, &Reference::column) !=
                    std::end(references)) {
                    row.*std::get<std::uint32_t Row::*>(column.member) =
                        static_cast<std::uint32_t>(&row - rows.data());
                    continue;
                }
                ++next;
                std::visit(
                    [&]<class Value>(Value Row::*member) {
                        if constexpr (Worded<Value>)
                            row.*member = static_cast<Value>(next % Words<Value>::all.size());
                        else if constexpr (std::is_same_v<Value, std::string>)
                            row.*member = fmt::format("{} \u00b5 {}", column.name, next);
                        else
                            row.*member = static_cast<Value>(next * 0x9e3779b97f4a7c15 >> 20);
                    },
                    column.member);
            }
    });
    return results;
}

/// "" if they are the same to the bit, else where they first differ.
inline std::string difference(const Results& a, const Results& b) {
    if (a.run_uuid != b.run_uuid || a.created_utc != b.created_utc ||
        a.sweep_hash != b.sweep_hash || a.generator != b.generator || a.complete != b.complete)
        return "header";
    if (a.texts != b.texts)
        return "texts";
    std::string where;
    for_each_table([&]<class Row>(const Table<Row>& table) {
        const auto &left = a.*table.rows, &right = b.*table.rows;
        if (left.size() != right.size()) {
            where = fmt::format("{}: {} and {} rows", table.name, left.size(), right.size());
            return;
        }
        for (std::size_t i = 0; i < left.size(); ++i)
            for (const auto& column : table.columns)
                std::visit(
                    [&]<class Value>(Value Row::*member) {
                        bool equal = left[i].*member == right[i].*member;
                        if constexpr (std::is_same_v<Value, double>)
                            equal = std::bit_cast<std::uint64_t>(left[i].*member) ==
                                    std::bit_cast<std::uint64_t>(right[i].*member);
                        if (!equal && where.empty())
                            where = fmt::format("{}.{} of row {}", table.name, column.name, i);
                    },
                    column.member);
    });
    return where;
}

} // namespace boxwood::results

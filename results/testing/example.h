#pragma once

#include "results/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <string>

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
    for (const Table& table : tables()) {
        table.resize(results, rows_per_table);
        const auto rows = table.rows(results);
        for (std::size_t i = 0; i < rows.n; ++i)
            for (const Column& column : table.columns) {
                if (std::ranges::find(references, column.name, &Reference::column) !=
                    std::end(references)) {
                    column.value<std::uint32_t>(rows[i]) = static_cast<std::uint32_t>(i);
                    continue;
                }
                const std::uint64_t number = ++next * 0x9e3779b97f4a7c15 >> 20;
                if (column.stored == Stored::uint32)
                    column.value<std::uint32_t>(rows[i]) = static_cast<std::uint32_t>(number);
                else if (column.stored == Stored::uint64)
                    column.value<std::uint64_t>(rows[i]) = number;
                else if (column.stored == Stored::real)
                    column.value<double>(rows[i]) = static_cast<double>(number);
                else if (column.words.empty())
                    column.set_text(rows[i], fmt::format("{} \u00b5 {}", column.name, next));
                else
                    column.set_text(rows[i], column.words[next % column.words.size()]);
            }
    }
    return results;
}

/// "" if they are the same to the bit, else where they first differ.
inline std::string difference(const Results& a, const Results& b) {
    if (a.run_uuid != b.run_uuid || a.created_utc != b.created_utc ||
        a.sweep_hash != b.sweep_hash || a.generator != b.generator || a.complete != b.complete)
        return "header";
    if (a.texts != b.texts)
        return "texts";
    for (const Table& table : tables()) {
        const auto left = table.rows(a), right = table.rows(b);
        if (left.n != right.n)
            return fmt::format("{}: {} and {} rows", table.name, left.n, right.n);
        for (std::size_t i = 0; i < left.n; ++i)
            for (const Column& column : table.columns)
                if (column.stored == Stored::text
                        ? column.text(left[i]) != column.text(right[i])
                        : std::memcmp(left[i] + column.at, right[i] + column.at, column.size) != 0)
                    return fmt::format("{}.{} of row {}", table.name, column.name, i);
    }
    return "";
}

} // namespace boxwood::results

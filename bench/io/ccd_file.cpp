#include "bench/io/ccd_file.h"

#include "bench/io/csv.h"
#include "kernels/oracle/exact_vector.h"
#include "kernels/oracle/roots.h"
#include "scenes/text/fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boxwood::bench {
namespace {

constexpr std::string_view columns = "x_num,x_den,y_num,y_den,z_num,z_den,truth";
constexpr std::array names{"x_num", "x_den", "y_num", "y_den", "z_num", "z_den", "truth"};
constexpr std::size_t rows_per_query = 8;

/// The place of a row, for error messages.
struct Row {
    const std::string& source;
    std::size_t line;

    [[noreturn]] void refuse(const std::string& what) const { throw_bad_row(source, line, what); }
};

mpz_class integer(std::string_view text, std::size_t column, const Row& row) {
    std::string_view digits = text;
    if (!digits.empty() && (digits.front() == '-' || digits.front() == '+'))
        digits.remove_prefix(1);
    if (digits.empty() || !std::ranges::all_of(digits, [](char c) { return c >= '0' && c <= '9'; }))
        row.refuse(fmt::format("{} is {}; rows are integers {} (write 0.5 as 1,2; put # before "
                               "a header line)",
                               names[column], text.empty() ? "empty" : boxwood::quoted(text),
                               columns));
    mpz_class n(std::string(digits), 10);
    return text.front() == '-' ? mpz_class(-n) : n;
}

struct Content {
    oracle::RationalPoint point;
    bool touches;
};

Content parse(std::string_view text, const Row& row) {
    const auto n_columns = 1 + static_cast<std::size_t>(std::ranges::count(text, ','));
    if (n_columns != names.size())
        row.refuse(fmt::format("{} column{}, expected {}: {}", n_columns, n_columns == 1 ? "" : "s",
                               names.size(), columns));
    std::array<mpz_class, names.size()> numbers;
    for (std::size_t i = 0; i < numbers.size(); ++i)
        numbers[i] = integer(trimmed(take_until(text, ',')), i, row);
    Content content;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (numbers[2 * axis + 1] == 0)
            row.refuse(fmt::format("{} is 0; a denominator must be another number (write 5 as 5,1)",
                                   names[2 * axis + 1]));
        content.point[axis] = mpq_class(numbers[2 * axis], numbers[2 * axis + 1]);
        content.point[axis].canonicalize();
    }
    const mpz_class& truth = numbers.back();
    if (truth != 0 && truth != 1)
        row.refuse(fmt::format("truth is {}; it must be 0 (they never touch) or 1 (they do)",
                               boxwood::quoted(truth.get_str())));
    content.touches = truth == 1;
    return content;
}

} // namespace

std::vector<CcdFileQuery> read_ccd_queries(std::string_view text, const std::string& source) {
    text = without_byte_order_mark(text);
    std::vector<CcdFileQuery> queries;
    std::size_t n_rows = 0;
    for (std::size_t line = 1; !text.empty(); ++line) {
        const std::string_view content = trimmed(take_until(text, '\n'));
        if (content.empty() || content.front() == '#')
            continue;
        const Row row{source, line};
        auto [point, touches] = parse(content, row);
        const std::size_t place = n_rows++ % rows_per_query;
        if (place == 0)
            queries.emplace_back().touches = touches;
        CcdFileQuery& query = queries.back();
        if (touches != query.touches)
            row.refuse(fmt::format("truth is {}, but {} in line {}; it must be the same in all {} "
                                   "rows of a query",
                                   touches ? 1 : 0, query.touches ? 1 : 0, query.lines[0],
                                   rows_per_query));
        query.lines[place] = line;
        (place < 4 ? query.motion.start : query.motion.end)[place % 4] = std::move(point);
    }
    if (n_rows == 0)
        warn_of_no_rows(source, columns);
    if (const std::size_t left = n_rows % rows_per_query; left != 0)
        throw_bad_row(source, queries.back().lines[0],
                      fmt::format("the last query has {} row{} of {}: four points at the start, "
                                  "then the same at the end; is the file cut short?",
                                  left, left == 1 ? "" : "s", rows_per_query));
    return queries;
}

LinearMotion exact_doubles(const CcdFileQuery& query, const std::string& source) {
    LinearMotion motion;
    for (std::size_t i = 0; i < rows_per_query; ++i)
        for (int axis = 0; axis < 3; ++axis) {
            const mpq_class& x =
                (i < 4 ? query.motion.start : query.motion.end)[i % 4][std::size_t(axis)];
            const double nearest = oracle::nearest_double(x);
            if (!std::isfinite(nearest) || oracle::exact(nearest) != x)
                throw_bad_row(source, query.lines[i],
                              fmt::format("{} = {} is not exactly a double, and this kernel reads "
                                          "doubles; use --kernel exact",
                                          "xyz"[axis], boxwood::quoted(x.get_str())));
            (i < 4 ? motion.start : motion.end)[i % 4][axis] = nearest;
        }
    return motion;
}

} // namespace boxwood::bench

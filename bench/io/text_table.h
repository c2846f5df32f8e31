#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood::bench {

/// Rows of text in aligned columns. A heading that starts with '>' makes its column right-aligned.
class TextTable {
  public:
    explicit TextTable(std::vector<std::string> headings);
    /// One cell per heading; missing ones are empty.
    void add(std::vector<std::string> row);
    bool empty() const { return rows_.empty(); }
    std::string text() const;
    std::string markdown() const;

  private:
    std::vector<bool> is_right_;
    std::vector<std::string> headings_;
    std::vector<std::vector<std::string>> rows_;
};

/// Three digits with the unit that suits: "12.3 ms"; "-" for NaN.
std::string time_text(double ns);

/// Three digits: "0.412", "3.12", "120"; "-" for NaN.
std::string ratio_text(double ratio);

/// A name as words: blanks for underscores.
std::string spaced(std::string_view name);

// python/boxwood/results/words.py has the same rules; scripts/tests/numbers.csv is the test of
// both.

/// Whole KiB or MiB, rounded down; "?" for results::no_count.
std::string bytes_text(std::uint64_t bytes);

/// "?" for an empty text.
std::string or_unknown(std::string text);

} // namespace boxwood::bench

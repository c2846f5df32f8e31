#pragma once

#include "bench/analysis/compare_files.h"
#include "results/results.h"

#include <string>
#include <string_view>

namespace boxwood::bench {

/// "5%" or "0.5 %" as 0.05 or 0.005. Throws BadInput for anything else.
double percent_of(const std::string& text);

/// The 0.05 of "slower>5%", or of another change. Throws BadInput for anything else.
double fail_threshold(const std::string& condition, std::string_view change = "slower");

/// The exit code of `boxwood compare`.
int exit_code_of(Gate gate);

/// "passes", "open", "fails".
std::string_view gate_word(Gate gate);

/// Why a file whose seal is broken passes no gate.
inline constexpr std::string_view no_evidence =
    "a file was changed after it was written, and so need not say what was measured";

/// The commit and machine of a file, and whether it was changed; one line or two.
std::string file_text(std::string_view which, const results::Results& results);

struct FileView {
    bool markdown = false;
    bool all = false; ///< else only the rows that changed or are open, and none of the peers'
};
/// One line with the verdict, what is to be known about it, and the table.
std::string comparison_text(const results::Results& base, const results::Results& head,
                            const FileComparison& comparison, const FileOptions& options,
                            const FileView& view = {});
std::string comparison_json(const results::Results& base, const results::Results& head,
                            const FileComparison& comparison);

} // namespace boxwood::bench

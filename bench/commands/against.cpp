#include "bench/commands/against.h"

#include "bench/commands/compare.h"
#include "bench/io/bad_input.h"
#include "bench/io/read_results.h"

#include <fmt/format.h>

namespace boxwood::bench {

int run_against(const std::filesystem::path& program, const SweepOptions& options,
                const FileOptions& compared) {
    if (!sweep_in_turns(program, options))
        return exit_interrupted;
    const std::filesystem::path base_file = base_file_of(options.out);
    const results::Results base = read_results(base_file), head = read_results(options.out);
    const FileComparison comparison = compare_files(base, head, compared);
    fmt::print("{}\nbase     {}\nhead     {}\n", comparison_text(base, head, comparison, compared),
               base_file.string(), options.out.string());
    return exit_code_of(comparison.gate);
}

} // namespace boxwood::bench

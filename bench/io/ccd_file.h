#pragma once

#include "kernels/oracle/continuous.h"

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood::bench {

/// One query of continuous collision in the form of the sample queries of Wang et al. 2021: four
/// rational points at the start and at the end, and whether the features touch in between.
struct CcdFileQuery {
    oracle::RationalMotion motion;
    bool touches = false;
    std::array<std::size_t, 8> lines{}; ///< of its rows, from 1
};

/// Reads rows x_num,x_den,y_num,y_den,z_num,z_den,truth of integers of any size, eight a query: the
/// points at the start, then at the end; truth, 0 or 1, is the same in all eight. Blank lines and
/// lines with # in front are skipped; if that is all there is, a warning and no query. Throws
/// BadInput naming source:line, what and the remedy.
std::vector<CcdFileQuery> read_ccd_queries(std::string_view text, const std::string& source);

/// The motion as doubles. Throws BadInput naming source:line for a coordinate that is not a double.
LinearMotion exact_doubles(const CcdFileQuery& query, const std::string& source);

} // namespace boxwood::bench

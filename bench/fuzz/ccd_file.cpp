/// `query ccd`: no kernel fails on what the reader takes.

#include "bench/io/ccd_file.h"
#include "bench/fuzz/csv.h"

namespace boxwood::fuzz {

void ccd_file(Bytes bytes) {
    static const ScratchFile file(".csv");
    bench::CcdQuery query;
    query.queries = file.holding(bytes).string();
    query.max_checks.reset();
    query.format.json = true;
    for (const char* kind : {"vertex-face", "edge-edge"}) {
        query.kind = kind;
        query.kernel = "cubic_f64";
        printed(query);
        query.kernel = "exact"; // numbers of any size: time grows with their digits
        if (bytes.size() < 2000)
            printed(query);
    }
}

} // namespace boxwood::fuzz

#include "results/detail/handle.h"

#include <fmt/format.h>

namespace boxwood::results::detail {
namespace {

std::string innermost_cause() {
    std::string cause;
    // Upward goes from the innermost call to the API: the first description is the most specific.
    const H5E_walk2_t take_first = [](unsigned, const H5E_error2_t* error, void* out) -> herr_t {
        auto& found = *static_cast<std::string*>(out);
        if (found.empty() && error->desc)
            found = error->desc;
        return 0;
    };
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first, &cause);
    return cause.empty() ? "HDF5 gives no cause" : cause;
}

} // namespace

Hdf5Error::Hdf5Error(std::string_view doing)
    : std::runtime_error(fmt::format("{}: {}", doing, innermost_cause())) {}

Handle text_type() {
    Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "string type");
    checked(H5Tset_size(type, H5T_VARIABLE), "string type");
    checked(H5Tset_cset(type, H5T_CSET_UTF8), "string type");
    return type;
}

Handle string_type(std::size_t width) {
    Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "string type");
    checked(H5Tset_size(type, width), "string type");
    checked(H5Tset_strpad(type, H5T_STR_NULLPAD), "string type");
    checked(H5Tset_cset(type, H5T_CSET_UTF8), "string type");
    return type;
}

Handle number_type(Stored stored, std::string_view doing) {
    return Handle(H5Tcopy(stored == Stored::real     ? H5T_NATIVE_DOUBLE
                          : stored == Stored::uint32 ? H5T_NATIVE_UINT32
                                                     : H5T_NATIVE_UINT64),
                  H5Tclose, doing);
}

Silence::Silence() {
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Silence::~Silence() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }

} // namespace boxwood::results::detail

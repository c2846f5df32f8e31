#include "kernels/triangle_distance/features.h"

#include "kernels/triangle_distance/detail/nearest_pair.h"

namespace boxwood {

template <class Real, bool by_cross>
Distance FeatureDistance<Real, by_cross>::distance(const Triangle<Real>& a,
                                                   const Triangle<Real>& b) {
    return detail::measured<&detail::NearestPairSearch<Real, by_cross>::find>(a, b);
}

template struct FeatureDistance<float, false>;
template struct FeatureDistance<double, false>;
template struct FeatureDistance<double, true>;

} // namespace boxwood

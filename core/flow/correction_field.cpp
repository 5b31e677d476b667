#include "core/flow/correction_field.h"

#include <algorithm>

#include "core/mesh/element_locator.h"

namespace lamella {

struct CorrectionField::Impl {
  Impl(const SimplexMesh<3>& mesh, const Progress& progress)
      : elements(mesh.elements), locator(mesh, progress) {}

  template <class T>
  T at(const std::vector<T>& values, const Vec<3>& x, T sum) const {
    const Located<3> place = locator.locate(x);
    const auto& e = elements[static_cast<std::size_t>(place.element)];
    for (int k = 0; k < 4; ++k) sum += place.weights[k] * values[e[k]];
    return sum;
  }

  std::vector<SimplexMesh<3>::Element> elements;
  ElementLocator<3> locator;
  std::vector<Mat<3>> tensors;  ///< [node]; this or the factors
  std::vector<double> factors;
};

Result<CorrectionField> CorrectionField::make(const SimplexMesh<3>& mesh,
                                              std::vector<Mat<3>> tensors,
                                              std::vector<double> factors,
                                              const Progress& progress) {
  auto impl = std::make_shared<Impl>(mesh, progress);
  if (progress.cancelled()) return cancelled_error();
  impl->tensors = std::move(tensors);
  impl->factors = std::move(factors);
  CorrectionField out;
  out.impl_ = std::move(impl);
  return out;
}

Result<CorrectionField> CorrectionField::adding(const SimplexMesh<3>& mesh,
                                                std::vector<Mat<3>> tensors,
                                                const Progress& progress) {
  return make(mesh, std::move(tensors), {}, progress);
}

Result<CorrectionField> CorrectionField::scaling(const SimplexMesh<3>& mesh,
                                                 std::vector<double> factors,
                                                 const Progress& progress) {
  return make(mesh, {}, std::move(factors), progress);
}

Metric<3> CorrectionField::apply(const Vec<3>& x, const Metric<3>& asked, double h_min) const {
  if (!impl_) return asked;
  Metric<3> metric = asked;
  if (impl_->factors.empty())
    metric += impl_->at<Mat<3>>(impl_->tensors, x, Mat<3>::Zero());
  else
    metric *= eigenvalue_from_size(factor(x));
  const double finest = std::max(eigenvalue_from_size(h_min), spectrum<3>(asked).values.maxCoeff());
  const Spectrum<3> found = spectrum<3>(metric);
  if (found.values.maxCoeff() <= finest) return metric;
  return found.vectors * found.values.cwiseMin(finest).asDiagonal() * found.vectors.transpose();
}

double CorrectionField::factor(const Vec<3>& x) const {
  if (!impl_ || impl_->factors.empty()) return 1;
  return impl_->at<double>(impl_->factors, x, 0);
}

}  // namespace lamella

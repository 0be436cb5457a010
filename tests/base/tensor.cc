// SPDX-License-Identifier: GPL-3.0-or-later
// Packs and small tensors agree, lane by lane, with plain doubles and with deal.II's tensors.
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <coracle/base/tensor.h>

#include "tests.h"

#include <random>

using namespace coracle;

std::mt19937 generator(1);

double
random_number()
{
  return std::uniform_real_distribution<>(-1, 1)(generator);
}

template <int dim>
Matrix<dim, Pack8>
random_matrix()
{
  Matrix<dim, Pack8> a{};
  for (auto &row : a)
    for (Pack8 &entry : row)
      for (int lane = 0; lane < pack_size; ++lane)
        entry[lane] = random_number();
  return a;
}

template <int dim>
dealii::Tensor<2, dim>
lane_of(const Matrix<dim, Pack8> &a, const int lane)
{
  dealii::Tensor<2, dim> result;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      result[i][j] = a[i][j][lane];
  return result;
}

template <int dim>
Matrix<dim, double>
plain(const dealii::Tensor<2, dim> &a)
{
  Matrix<dim, double> result;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      result[i][j] = a[i][j];
  return result;
}

/// Largest difference of packs to deal.II, and of plain doubles to packs.
template <int dim>
double
compare()
{
  double     worst  = 0;
  const auto differ = [&](const double a, const double b) {
    worst = std::max(worst, std::fabs(a - b));
  };

  const Matrix<dim, Pack8>    a = random_matrix<dim>(), b = random_matrix<dim>();
  const Matrix<dim, Pack8>    ab = product<dim>(a, b), adjugate_a = adjugate<dim>(a);
  const Symmetric<dim, Pack8> symmetric_a = symmetric_part<dim>(a);
  for (int lane = 0; lane < pack_size; ++lane)
    {
      const dealii::Tensor<2, dim> A = lane_of<dim>(a, lane), B = lane_of<dim>(b, lane);
      differ(determinant<dim>(a)[lane], dealii::determinant(A));
      differ(trace<dim>(a)[lane], dealii::trace(A));
      differ(determinant<dim>(plain<dim>(A)), determinant<dim>(a)[lane]);
      const dealii::Tensor<2, dim> expected_product  = A * B;
      const dealii::Tensor<2, dim> expected_adjugate = dealii::determinant(A) * dealii::invert(A);
      const dealii::SymmetricTensor<2, dim> S        = dealii::symmetrize(A);
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          {
            differ(ab[i][j][lane], expected_product[i][j]);
            differ(adjugate_a[i][j][lane], expected_adjugate[i][j]);
            differ(symmetric_a(i, j)[lane], S[i][j]);
          }
      differ(symmetric_a.trace()[lane], dealii::trace(A));
    }
  return worst;
}

void
test_packs()
{
  const Pack8 a = {1, 2, 3, 4, 5, 6, 7, 8}, b = {8, 7, 6, 5, 4, 3, 2, 1};
  bool        right = (sum(a) == 36 && sum(a * b) == 120 && splat<double>(3.) == 3.);
  for (int lane = 0; lane < pack_size; ++lane)
    {
      right &= (max(a, b)[lane] == std::max(a[lane], b[lane]));
      right &= (min(a, b)[lane] == std::min(a[lane], b[lane]));
      right &= (abs(a - b)[lane] == std::fabs(a[lane] - b[lane]));
      right &= (select(a > b, a, b)[lane] == (a[lane] > b[lane] ? a[lane] : b[lane]));
      right &= (sqrt(a)[lane] == std::sqrt(a[lane]) && log(a)[lane] == std::log(a[lane]));
      right &= (pow(a, 0.7)[lane] == std::pow(a[lane], 0.7));
    }
  double memory[pack_size + 1] = {};
  store(memory + 1, a); // any address
  right &= (sum(load<Pack8>(memory + 1) - a) == 0 && memory[0] == 0);
  store_first(memory, b, 2);
  right &= (memory[0] == 8 && memory[1] == 7 && memory[2] == 2);
  deallog << "packs: " << right << std::endl;
}

int
main()
{
  initlog();
  test_packs();
  deallog << "tensors agree to round-off in 2-D: " << (compare<2>() < 1e-14) << std::endl;
  deallog << "tensors agree to round-off in 3-D: " << (compare<3>() < 1e-14) << std::endl;
  const Symmetric<2, double> plane_strain{{{1, 2, 4, 8}}};
  deallog << "plane strain keeps zz: " << plane_strain.trace() << ' ' << plane_strain(0, 1) << ' '
          << plane_strain(1, 0) << std::endl;
  const Symmetric<3, double> s{{{1, 2, 3, 12, 23, 13}}};
  deallog << "order of entries: " << s(0, 1) << ' ' << s(2, 1) << ' ' << s(0, 2) << std::endl;
}

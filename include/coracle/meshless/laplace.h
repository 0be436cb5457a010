// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/meshless/tessellation.h>

#include <deal.II/base/tensor.h>

namespace coracle::meshless
{
/**
 * Laplace (non-Sibsonian) shape functions of one element and their gradients at
 * its quadrature points. An object is set to one element after the other and
 * allocates only for the largest.
 *
 * With the Voronoi cell that x would have among the element's nodes, s_i the
 * length or area of its face towards node i and h_i the distance to the node,
 *
 *   N_i = (s_i / h_i) / sum_j (s_j / h_j).
 *
 * The cell's corners are the centres of spheres through x and the nodes of one
 * facet of the element. Where the nodes are on one sphere that is the Voronoi
 * cell; where they are so only within the tolerance of merging, it is its smooth
 * continuation, which still gives back linear functions exactly and is linear on
 * facets, so that neighbours fit.
 *
 * On a simplex these are the linear functions: one quadrature point. Elsewhere
 * each simplex of the element has a rule of degree two. Gradients are then shifted
 * by a constant for each node, so that their integral over the element is that of
 * N_i n over its surface, as Gauss's theorem demands; otherwise a constant pressure
 * would push at points inside the fluid. (Squares and cubes need no shift.)
 *
 * Source: Del Pin, Idelsohn, Onate & Calvo (2003), section 2; Belikov and others
 * (1997), The non-Sibsonian interpolation; Christ, Friedberg & Lee (1982); for the
 * shift, Talischi and others (2015), Gradient correction for polygonal and
 * polyhedral finite elements.
 */
template <int dim>
class LaplaceShape
{
public:
  void reinit(const PointCloud<dim>   &points,
              const Tessellation<dim> &tessellation,
              const unsigned int       element);

  unsigned int n_nodes() const { return n; }
  unsigned int n_points() const { return weights.size(); }
  /// Quadrature weight: the weights of an element add up to its volume [m^dim]; where it has a face
  /// that is bent within the tolerance of merging, to what a smooth surface there encloses.
  double weight(const unsigned int q) const { return weights[q]; }
  /// Where [m].
  const dealii::Point<dim> &point(const unsigned int q) const { return quadrature[q]; }
  /// Shape function of the i-th node of the element.
  double value(const unsigned int q, const unsigned int i) const { return values[q * n + i]; }
  /// Its gradient [1/m].
  const dealii::Tensor<1, dim> &gradient(const unsigned int q, const unsigned int i) const
  {
    return gradients[q * n + i];
  }

  /// Values and gradients of all nodes at a point inside the element, which must not be a simplex.
  void evaluate(const dealii::Point<dim> &x, double *value, dealii::Tensor<1, dim> *gradient) const;

private:
  /// A facet of the element: nodes, outward unit normal, and its circle (in 2-D, its ends).
  struct Facet
  {
    std::array<unsigned int, dim> node;
    dealii::Tensor<1, dim>        normal;
    dealii::Point<dim>            center;
    double                        radius_square;
    unsigned int                  face;
  };

  void set_simplex(const double volume);
  void set_quadrature(const PointCloud<dim>   &points,
                      const Tessellation<dim> &tessellation,
                      const unsigned int       element);
  void set_facets(const Tessellation<dim> &tessellation, const unsigned int element);
  void pair_facets();
  void make_consistent();
  /// Integrals over the surface of a function times the outward normal, for each node's function.
  void integrate_surface();
  void integrate_polygon(const unsigned int face);
  void evaluate_polygon(const dealii::Point<dim> &x, const dealii::Tensor<1, dim> &normal);

  unsigned int                        n = 0;
  std::vector<dealii::Point<dim>>     nodes;
  std::vector<double>                 weights, values;
  std::vector<dealii::Point<dim>>     quadrature;
  std::vector<dealii::Tensor<1, dim>> gradients;

  std::vector<Facet> facets;
  /// In 3-D, edges as they turn around a facet: first and second node, the facet, its neighbour.
  std::vector<std::array<unsigned int, 4>> pairs;
  std::vector<std::array<unsigned int, 3>> unpaired;
  std::vector<dealii::Tensor<1, dim>>      surface;
  /// Of the polygon at work: its edges, the nodes in its plane, functions and their integrals.
  std::vector<std::pair<unsigned int, unsigned int>> rim;
  std::vector<dealii::Point<dim>>                    in_plane;
  std::vector<double>                                face_value, face_integral;
  std::vector<dealii::Tensor<1, dim>>                face_gradient;

  mutable std::vector<dealii::Point<dim>>     corners;
  mutable std::vector<dealii::Tensor<1, dim>> slides, faces;
};
} // namespace coracle::meshless

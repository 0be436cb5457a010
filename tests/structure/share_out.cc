// SPDX-License-Identifier: GPL-3.0-or-later
// Elements go to other ranks by their weights, and nothing but the rank changes: every node and
// element has the same state, bit by bit, the body moves on as if it had stayed, with hanging
// nodes, on any number of ranks and on ranks without elements; mesh and weights are found again
// from what is saved, also on as many ranks in the same places.
#include <coracle/base/mpi.h>

#include <cstring>
#include <map>

#include "../memory_store.h"
#include "bodies.h"

using namespace coracle;

namespace
{
const MPI_Comm comm = MPI_COMM_WORLD;

std::string
text(const std::string &model, const std::string &integration, const int dim)
{
  return "subsection Materials\n subsection m\n set Model = " + model +
         "\n set Density = 1000\n set Young modulus = 1 MPa\n set Poisson ratio = 0.3\n end\nend\n"
         "subsection Bodies\n subsection body\n set Material = m\n set Integration = " +
         integration +
         "\n subsection Mesh\n set Subdivisions = " + (dim == 2 ? "6, 5" : "4, 3, 3") +
         "\n set Refined region = -1, -1, " + (dim == 2 ? "0.4, 0.5" : "-1, 0.4, 0.5, 0.5") +
         "\n end\n subsection Boundary conditions\n subsection held\n set Boundary id = 0\n"
         " set Directions = x\n end\n end\n subsection Loads\n subsection push\n"
         " set Pressure = 1e3*y\n end\n end\n end\nend\n";
}

/// What a body knows of its nodes (owners) and elements, by key, on all ranks.
using State = std::map<std::pair<int, std::uint64_t>, std::vector<double>>;

template <int dim>
State
state_of(SolidBody<dim> &body)
{
  // The body's own listing of its state, as a single rank sees its part.
  MemoryStore store(1);
  Archive     archive(store, Archive::Mode::save, 0, 1);
  body.serialize(archive);
  std::vector<double> mine;
  const auto          values_of = [&](const std::string &name) {
    Block               block;
    const auto          bytes = store.get(0, "body body/" + name, block);
    std::vector<double> values(bytes.size() / sizeof(double));
    if (!bytes.empty())
      std::memcpy(values.data(), bytes.data(), bytes.size());
    return std::make_pair(block.n_rows, values);
  };
  const auto add = [&](const int kind, const auto &keys, const unsigned int n, const auto &found) {
    const std::size_t n_values = found.first, stride = found.second.size() / n_values;
    for (unsigned int i = 0; i < n; ++i)
      {
        mine.insert(mine.end(), {double(kind), double(keys(i)), double(n_values)});
        for (std::size_t c = 0; c < n_values; ++c)
          mine.push_back(found.second[c * stride + i]);
      }
  };
  add(
    0,
    [&](const unsigned int n) { return body.key(n); },
    body.mesh().n_owned_nodes(),
    values_of("nodes/values"));
  add(
    1,
    [&](const unsigned int e) { return body.mesh().element_keys[e]; },
    body.mesh().n_elements(),
    values_of("elements/values"));
  State result;
  for (const auto &of_rank : dealii::Utilities::MPI::all_gather(comm, mine))
    for (std::size_t i = 0; i < of_rank.size();)
      {
        const std::size_t n = of_rank[i + 2];
        result[{int(of_rank[i]), std::uint64_t(of_rank[i + 1])}] =
          std::vector<double>(&of_rank[i + 3], &of_rank[i + 3] + n);
        i += 3 + n;
      }
  return result;
}

/// Largest difference over the largest value of each column of nodes and elements.
double
difference(const State &a, const State &b)
{
  if (a.size() != b.size())
    return 1e300;
  std::map<std::pair<int, std::size_t>, double> scale, worst;
  for (const auto &[key, row] : a)
    for (std::size_t c = 0; c < row.size(); ++c)
      {
        const std::pair<int, std::size_t> column(key.first, c);
        scale[column] = std::max(scale[column], std::fabs(row[c]));
        worst[column] = std::max(worst[column], std::fabs(row[c] - b.at(key)[c]));
      }
  double result = 0;
  for (const auto &[column, error] : worst)
    result = std::max(result, error / std::max(scale[column], 1e-300));
  return result;
}

/// Heavy on the right, then on the left, then nowhere.
template <int dim>
void
weigh(SolidBody<dim> &body, const unsigned int round)
{
  std::vector<double> weights;
  for (const auto &element : body.mesh().elements)
    {
      const double x = body.mesh().nodes[element[0]][0];
      weights.push_back(round == 0 && x > 0.6 ? 31. : round == 1 && x < 0.3 ? 4. : 1.);
    }
  body.set_element_weights(weights);
}

/// Largest part of a rank of all weight, less an equal one, over the heaviest element.
template <int dim>
double
excess(const SolidBody<dim> &body)
{
  double mine = 0, heaviest = 0;
  for (const double weight : body.mesh().weights())
    {
      mine += weight;
      heaviest = std::max(heaviest, weight);
    }
  return (mpi::max(mine, comm) - mpi::sum(mine, comm) / mpi::n_ranks(comm)) /
         mpi::max(heaviest, comm);
}

template <int dim>
void
carry(const std::string &model, const std::string &integration)
{
  const BodyCase body_case(text(model, integration, dim), dim);
  const auto     moving = body_case.solid<dim>(), staying = body_case.solid<dim>();
  for (auto *body : {moving.get(), staying.get()})
    for (unsigned int n = 0; n < body->mesh().n_nodes(); ++n)
      for (int d = 0; d < dim; ++d)
        body->nodes()[NodeColumns<dim>::velocity + d][n] =
          std::sin(3 * body->mesh().nodes[n][0] + d) + 0.1 * d;
  const double dt    = 0.2 * stable_step(*moving);
  double       time  = 0;
  bool         exact = true, same_step = true, even = true, moved = false;
  for (unsigned int round = 0; round < 3; ++round)
    {
      for (unsigned int i = 0; i < 20; ++i, time += dt)
        {
          step(*moving, time, dt);
          step(*staying, time, dt);
        }
      // Whole sums at the owners on both sides of the comparison.
      moving->assemble_forces(time);
      const State  before   = state_of(*moving);
      const double stable   = stable_step(*moving);
      const auto   elements = moving->mesh().element_keys;
      weigh(*moving, round);
      moving->share_out();
      exact     = exact && difference(before, state_of(*moving)) == 0;
      same_step = same_step && stable_step(*moving) == stable;
      // Families stay together.
      even  = even && excess(*moving) < (1 << dim);
      moved = moved || mpi::any(moving->mesh().element_keys != elements, comm);
    }
  for (unsigned int i = 0; i < 20; ++i, time += dt)
    {
      step(*moving, time, dt);
      step(*staying, time, dt);
    }
  moving->assemble_forces(time);
  staying->assemble_forces(time);
  const double worst = difference(state_of(*staying), state_of(*moving));
  deallog << dim << "-D, " << model << ", " << integration << ": elements moved "
          << (moved || mpi::n_ranks(comm) == 1) << ", state is the same " << exact
          << ", stable step too " << same_step << ", shared out by weight " << even
          << ", goes on as before " << (worst < 1e-11) << std::endl;
}

/// Each rank saves to its own store and loads from the parts of all.
template <int dim>
void
save_and_load()
{
  const BodyCase     body_case(text("neo-Hookean", "full", dim), dim);
  const auto         body    = body_case.solid<dim>();
  const unsigned int n_ranks = mpi::n_ranks(comm), rank = mpi::rank(comm);
  std::vector<bool>  wanted(body->mesh().n_elements());
  for (unsigned int e = 0; e < wanted.size(); ++e)
    wanted[e] = body->mesh().element_keys[e] % 5 == 0;
  weigh(*body, 0);
  body->refine(wanted);
  weigh(*body, 1);
  body->share_out();
  MemoryStore store(n_ranks);
  store.writer = rank;
  {
    Archive archive(store, Archive::Mode::save, rank, n_ranks);
    body->serialize(archive);
  }
  const auto loaded = body_case.solid<dim>();
  {
    Archive archive(store, Archive::Mode::load, rank, n_ranks);
    loaded->serialize(archive);
  }
  const bool same = loaded->mesh().element_keys == body->mesh().element_keys &&
                    loaded->mesh().weights() == body->mesh().weights();
  deallog << dim << "-D: loaded on the same ranks, all in its place " << !mpi::any(!same, comm)
          << ", state " << (difference(state_of(*body), state_of(*loaded)) == 0) << std::endl;
}

/// Fewer elements than ranks.
void
few()
{
  std::string whole = text("neo-Hookean", "full", 2);
  whole.replace(whole.find("6, 5"), 4, "2, 1");
  whole.replace(whole.find("set Refined region"), 18, "#");
  const BodyCase body_case(whole, 2);
  const auto     body   = body_case.solid<2>();
  const State    before = state_of(*body);
  weigh(*body, 1);
  body->share_out();
  deallog << "two elements: " << body->mesh().n_global_elements() << ", state is the same "
          << (difference(before, state_of(*body)) == 0) << std::endl;
}

template <int dim>
void
rigid()
{
  const BodyCase body_case(
    "subsection Bodies\n subsection body\n set Kind = rigid\n set Density = 1000\n"
    " subsection Mesh\n set Subdivisions = " +
      std::string(dim == 2 ? "6, 5" : "4, 3, 3") + "\n end\n end\nend\n",
    dim);
  const auto body = body_case.rigid<dim>();
  const auto sum  = [&] {
    double result = 0;
    for (unsigned int n = 0; n < body->mesh().n_owned_nodes(); ++n)
      result += body->key(n) * body->position(n).norm_square();
    return mpi::sum(result, comm);
  };
  const double        before  = sum();
  const std::uint64_t n_nodes = body->mesh().n_global_nodes();
  std::vector<double> weights(body->mesh().n_cells(), 1.);
  if (mpi::rank(comm) == 0)
    std::fill(weights.begin(), weights.end(), 20.);
  body->set_element_weights(weights);
  body->share_out();
  std::uint64_t n_facets = mpi::sum<std::uint64_t>(body->facets().size(), comm);
  deallog << dim << "-D, rigid: facets " << n_facets << ", nodes in place "
          << (std::fabs(sum() - before) < 1e-12 * before &&
              body->mesh().n_global_nodes() == n_nodes)
          << std::endl;
}
} // namespace

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  mpi_initlog();
  deallog << std::boolalpha;
  carry<2>("neo-Hookean", "full");
  carry<2>("linear elastic", "one point");
  carry<3>("neo-Hookean", "one point");
  carry<3>("linear elastic", "full");
  save_and_load<2>();
  save_and_load<3>();
  few();
  rigid<2>();
  rigid<3>();
}

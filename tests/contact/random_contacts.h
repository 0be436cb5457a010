// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scene.h"

using namespace scene;

/// Random contacts between points in one or two cells and a light plate.
template <int dim>
struct Problem
{
  std::vector<Unknown<dim>>                 unknowns;
  std::vector<Contact<dim>>                 contacts;
  std::vector<RigidUnknown<dim>>            rigid;
  Rows                                      rows;
  std::vector<typename WarmStart<dim>::Key> keys;

  Problem(const unsigned int n_contacts,
          const unsigned int seed,
          const double       friction,
          const bool         with_rigid)
  {
    std::mt19937                     generator(seed);
    std::uniform_real_distribution<> uniform(0, 1);
    const unsigned int               n_unknowns = 12;
    for (unsigned int i = 0; i < n_unknowns; ++i)
      {
        Unknown<dim> u;
        for (int d = 0; d < dim; ++d)
          {
            u.velocity[d]     = uniform(generator) - 0.5;
            u.inverse_mass[d] = 0.5 + uniform(generator);
          }
        u.velocity[dim - 1] -= (i < 8 ? 1. : -1.);
        if (i == 3)
          u.inverse_mass[0] = 0; // a wall
        u.key   = 77 * i;
        u.owner = i % dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
        unknowns.push_back(u);
      }
    RigidUnknown<dim> body;
    body.velocity[0] = 0.3;
    body.spin[2]     = 0.7;
    for (int d = 0; d < dim; ++d)
      body.inverse_mass[d] = 0.2;
    for (unsigned int d = 0; d < 3; ++d)
      body.inverse_inertia[d][d] = 0.4 + 0.1 * d;
    if (with_rigid)
      rigid.push_back(body);

    for (unsigned int c = 0; c < n_contacts; ++c)
      {
        double sum = 0;
        for (unsigned int side = 0; side < 2; ++side)
          {
            const bool on_body = (side == 1 && with_rigid && c % 2 == 0);
            for (unsigned int k = 0; k < 4 && !on_body; ++k)
              {
                const double w = (k == 3 ? 1 - sum : (1 - sum) * uniform(generator));
                sum            = (k == 3 ? 0. : sum + w);
                rows.entries.push_back({8 * side + (side == 0 ? k + 4 * (c % 2) : k), w});
              }
            rows.begin.push_back(rows.entries.size());
            if (side == 1)
              rows.rigid_body.push_back({{-1, on_body ? 0 : -1}});
          }
        Contact<dim> contact{};
        contact.set   = 0;
        contact.point = c;
        for (int d = 0; d < dim; ++d)
          contact.normal[d] = uniform(generator) - 0.5;
        contact.normal[dim - 1] += 1;
        contact.normal /= contact.normal.norm();
        for (int d = 0; d < dim; ++d)
          contact.place[d] = uniform(generator);
        contact.gap      = (c % 3 == 0 ? 0.012 : 0.009);
        contact.distance = 0.01;
        contact.friction = friction;
        contacts.push_back(contact);
        keys.push_back({c, 0});
      }
  }

  /// Another problem beside this one.
  void append(const Problem &other)
  {
    const unsigned int n_unknowns = unknowns.size(), n_bodies = rigid.size(),
                       n_entries = rows.entries.size();
    for (const auto &u : other.unknowns)
      {
        unknowns.push_back(u);
        unknowns.back().key += 77 * n_unknowns;
      }
    rigid.insert(rigid.end(), other.rigid.begin(), other.rigid.end());
    for (auto entry : other.rows.entries)
      {
        entry.unknown += n_unknowns;
        rows.entries.push_back(entry);
      }
    for (std::size_t side = 1; side < other.rows.begin.size(); ++side)
      rows.begin.push_back(n_entries + other.rows.begin[side]);
    for (auto bodies : other.rows.rigid_body)
      {
        for (int &b : bodies)
          b += (b >= 0 ? n_bodies : 0);
        rows.rigid_body.push_back(bodies);
      }
    for (auto contact : other.contacts)
      {
        contact.point = contacts.size();
        keys.push_back({contact.point, 0});
        contacts.push_back(contact);
      }
  }

  double target(const unsigned int c, const double dt) const
  {
    return -std::max(0., contacts[c].gap - contacts[c].distance) / dt;
  }

  /// The contacts of one rank; the unknowns only as far as they are used there.
  Problem part(const unsigned int rank, const unsigned int n_ranks) const
  {
    Problem result(0, 0, 0, false);
    result.unknowns.clear();
    result.rigid = rigid;
    std::map<unsigned int, unsigned int> number;
    for (unsigned int c = 0; c < contacts.size(); ++c)
      if (c % 2 == (rank < 2 ? rank : 5) || n_ranks == 1)
        {
          for (unsigned int side = 0; side < 2; ++side)
            {
              for (std::size_t e = rows.begin[2 * c + side]; e < rows.begin[2 * c + side + 1]; ++e)
                {
                  const auto entry =
                    number.emplace(rows.entries[e].unknown, result.unknowns.size());
                  if (entry.second)
                    result.unknowns.push_back(unknowns[rows.entries[e].unknown]);
                  result.rows.entries.push_back({entry.first->second, rows.entries[e].weight});
                }
              result.rows.begin.push_back(result.rows.entries.size());
            }
          result.rows.rigid_body.push_back(rows.rigid_body[c]);
          result.contacts.push_back(contacts[c]);
          result.keys.push_back(keys[c]);
        }
    return result;
  }
};

inline ContactOptions
sharp()
{
  ContactOptions options;
  options.tolerance          = 1e-10;
  options.maximum_iterations = 20000;
  return options;
}

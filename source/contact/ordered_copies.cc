// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/messages.h>
#include <coracle/contact/ordered_copies.h>

#include <algorithm>
#include <tuple>

namespace coracle::contact
{
namespace
{
constexpr int tag_copies = 4715;

/// A copy on its way to its owner.
struct Claim
{
  std::uint64_t key, block;
};

/// What the owner answers.
struct Answer
{
  unsigned int n_copies, is_first;
};
} // namespace

template <int dim>
OrderedCopies<dim>::OrderedCopies(MPI_Comm communicator) : communicator(communicator)
{}

template <int dim>
void
OrderedCopies<dim>::reinit(const std::vector<Unknown<dim>>  &copies,
                           const std::vector<std::uint64_t> &block)
{
  const int                              n = n_ranks(communicator);
  std::vector<std::vector<Claim>>        claims(n);
  std::vector<std::vector<unsigned int>> sent(n);
  for (unsigned int i = 0; i < copies.size(); ++i)
    {
      claims[copies[i].owner].push_back({copies[i].key, block[i]});
      sent[copies[i].owner].push_back(i);
    }
  const auto asked = all_to_all(claims, communicator);

  std::vector<Place> all;
  for (unsigned int r = 0; r < asked.size(); ++r)
    for (unsigned int i = 0; i < asked[r].size(); ++i)
      all.push_back({r, i});
  const auto claim = [&](const Place &p) { return asked[p.exchange][p.entry]; };
  std::sort(all.begin(), all.end(), [&](const Place &a, const Place &b) {
    return std::make_tuple(claim(a).key, claim(a).block) <
           std::make_tuple(claim(b).key, claim(b).block);
  });

  // Unknowns with one copy need no exchange.
  std::vector<std::vector<Answer>> answers(n);
  for (int r = 0; r < n; ++r)
    answers[r].resize(asked[r].size());
  order.clear();
  begin.assign(1, 0);
  for (std::size_t first = 0, last; first < all.size(); first = last)
    {
      for (last = first + 1; last < all.size() && claim(all[last]).key == claim(all[first]).key;)
        ++last;
      for (std::size_t i = first; i < last; ++i)
        answers[all[i].exchange][all[i].entry] = {static_cast<unsigned int>(last - first),
                                                  i == first};
      if (last > first + 1)
        {
          order.insert(order.end(), all.begin() + first, all.begin() + last);
          begin.push_back(order.size());
        }
    }
  const auto mine = all_to_all(answers, communicator);

  counts.assign(copies.size(), 1);
  is_first.assign(copies.size(), 1);
  to_owner.clear();
  from_users.clear();
  // Places in the messages without the copies that stay at home.
  std::vector<std::vector<unsigned int>> place(n);
  for (int r = 0; r < n; ++r)
    {
      Exchange up{r, {}, {}}, down{r, {}, {}};
      for (unsigned int i = 0; i < sent[r].size(); ++i)
        {
          counts[sent[r][i]]   = mine[r][i].n_copies;
          is_first[sent[r][i]] = mine[r][i].is_first;
          if (mine[r][i].n_copies > 1)
            up.index.push_back(sent[r][i]);
        }
      for (const Answer &answer : answers[r])
        {
          place[r].push_back(down.index.size());
          if (answer.n_copies > 1)
            down.index.push_back(place[r].size() - 1);
        }
      up.buffer.resize(dim * up.index.size());
      down.buffer.resize(dim * down.index.size());
      to_owner.push_back(std::move(up));
      from_users.push_back(std::move(down));
    }
  for (Place &p : order)
    p.entry = place[p.exchange][p.entry];
}

template <int dim>
void
OrderedCopies<dim>::swap(std::vector<Exchange> &from, std::vector<Exchange> &to)
{
  std::vector<MPI_Request> requests;
  for (auto &e : to)
    if (!e.buffer.empty())
      MPI_Irecv(e.buffer.data(),
                e.buffer.size(),
                MPI_DOUBLE,
                e.rank,
                tag_copies,
                communicator,
                &requests.emplace_back());
  for (auto &e : from)
    if (!e.buffer.empty())
      MPI_Isend(e.buffer.data(),
                e.buffer.size(),
                MPI_DOUBLE,
                e.rank,
                tag_copies,
                communicator,
                &requests.emplace_back());
  MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);
}

template <int dim>
void
OrderedCopies<dim>::average_change(std::vector<Lanes<dim>>       &value,
                                   const std::vector<Lanes<dim>> &before)
{
  for (auto &up : to_owner)
    for (unsigned int k = 0; k < up.index.size(); ++k)
      for (int d = 0; d < dim; ++d)
        up.buffer[dim * k + d] = value[up.index[k]][d] - before[up.index[k]][d];
  swap(to_owner, from_users);
  for_each_unknown([this](const Place *const first, const Place *const last) {
    for (int d = 0; d < dim; ++d)
      {
        double sum = 0;
        for (const Place *p = first; p != last; ++p)
          sum += from_users[p->exchange].buffer[dim * p->entry + d];
        for (const Place *p = first; p != last; ++p)
          from_users[p->exchange].buffer[dim * p->entry + d] = sum / double(last - first);
      }
  });
  swap(from_users, to_owner);
  for (const auto &up : to_owner)
    for (unsigned int k = 0; k < up.index.size(); ++k)
      for (int d = 0; d < dim; ++d)
        value[up.index[k]][d] = before[up.index[k]][d] + up.buffer[dim * k + d];
}

template <int dim>
void
OrderedCopies<dim>::sum_to_first(std::vector<Vector> &value)
{
  for (auto &up : to_owner)
    for (unsigned int k = 0; k < up.index.size(); ++k)
      for (int d = 0; d < dim; ++d)
        up.buffer[dim * k + d] = value[up.index[k]][d];
  swap(to_owner, from_users);
  for_each_unknown([this](const Place *const first, const Place *const last) {
    for (int d = 0; d < dim; ++d)
      {
        double sum = 0;
        for (const Place *p = first; p != last; ++p)
          sum += from_users[p->exchange].buffer[dim * p->entry + d];
        from_users[first->exchange].buffer[dim * first->entry + d] = sum;
      }
  });
  swap(from_users, to_owner);
  for (const auto &up : to_owner)
    for (unsigned int k = 0; k < up.index.size(); ++k)
      for (int d = 0; d < dim; ++d)
        value[up.index[k]][d] = is_first[up.index[k]] ? up.buffer[dim * k + d] : 0.;
}

template class OrderedCopies<2>;
template class OrderedCopies<3>;
} // namespace coracle::contact

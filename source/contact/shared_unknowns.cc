// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/messages.h>
#include <coracle/contact/shared_unknowns.h>

#include <algorithm>

namespace coracle::contact
{
namespace
{
constexpr int tag_up = 4711, tag_down = 4712;
}

template <int dim>
SharedUnknowns<dim>::SharedUnknowns(MPI_Comm communicator) : communicator(communicator)
{}

template <int dim>
void
SharedUnknowns<dim>::reinit(const std::vector<Unknown<dim>> &unknowns)
{
  counts.assign(unknowns.size(), 1);
  to_owner.clear();
  from_users.clear();
  slot_unknown.clear();
  const int n = n_ranks(communicator), me = my_rank(communicator);
  if (n == 1)
    return;

  std::vector<std::vector<std::uint64_t>>         keys(n);
  std::vector<std::vector<unsigned int>>          sent(n);
  std::vector<std::pair<std::uint64_t, unsigned>> own;
  for (unsigned int i = 0; i < unknowns.size(); ++i)
    if (unknowns[i].owner == me)
      own.emplace_back(unknowns[i].key, i);
    else
      {
        keys[unknowns[i].owner].push_back(unknowns[i].key);
        sent[unknowns[i].owner].push_back(i);
      }
  std::sort(own.begin(), own.end());
  const auto asked = all_to_all(keys, communicator);

  // One slot for each key that others asked for.
  std::vector<std::uint64_t> slots;
  for (const auto &list : asked)
    slots.insert(slots.end(), list.begin(), list.end());
  std::sort(slots.begin(), slots.end());
  slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
  slot_unknown.resize(slots.size());
  slot_count.resize(slots.size());
  for (unsigned int s = 0; s < slots.size(); ++s)
    {
      const auto found = std::lower_bound(own.begin(), own.end(), std::make_pair(slots[s], 0u));
      const bool mine  = (found != own.end() && found->first == slots[s]);
      slot_unknown[s]  = (mine ? static_cast<int>(found->second) : -1);
      slot_count[s]    = (mine ? 1 : 0);
    }
  std::vector<std::vector<unsigned int>> received(n);
  for (int r = 0; r < n; ++r)
    for (const auto key : asked[r])
      {
        received[r].push_back(std::lower_bound(slots.begin(), slots.end(), key) - slots.begin());
        ++slot_count[received[r].back()];
      }
  keep_shared(sent, received);
}

template <int dim>
void
SharedUnknowns<dim>::keep_shared(const std::vector<std::vector<unsigned int>> &sent,
                                 const std::vector<std::vector<unsigned int>> &received)
{
  const int                              n = sent.size();
  std::vector<std::vector<unsigned int>> answer(n);
  for (int r = 0; r < n; ++r)
    for (const unsigned int slot : received[r])
      answer[r].push_back(slot_count[slot]);
  const auto answers = all_to_all(answer, communicator);

  for (unsigned int s = 0; s < slot_unknown.size(); ++s)
    if (slot_unknown[s] >= 0)
      counts[slot_unknown[s]] = slot_count[s];
  for (int r = 0; r < n; ++r)
    {
      Exchange up{r, {}, {}}, down{r, {}, {}};
      for (unsigned int i = 0; i < sent[r].size(); ++i)
        {
          counts[sent[r][i]] = answers[r][i];
          if (answers[r][i] > 1)
            up.index.push_back(sent[r][i]);
        }
      for (const unsigned int slot : received[r])
        if (slot_count[slot] > 1)
          down.index.push_back(slot);
      up.buffer.resize(dim * up.index.size());
      down.buffer.resize(dim * down.index.size());
      if (!up.index.empty())
        to_owner.push_back(std::move(up));
      if (!down.index.empty())
        from_users.push_back(std::move(down));
    }
  slot_sum.resize(slot_unknown.size());
}

template <int dim>
void
SharedUnknowns<dim>::average_change(std::vector<Lanes<dim>>       &value,
                                    const std::vector<Lanes<dim>> &before)
{
  requests.clear();
  const auto start = [this](auto call, Exchange &e, const int tag) {
    requests.emplace_back();
    call(e.buffer.data(),
         static_cast<int>(e.buffer.size()),
         MPI_DOUBLE,
         e.rank,
         tag,
         communicator,
         &requests.back());
  };
  for (auto &down : from_users)
    start(MPI_Irecv, down, tag_up);
  for (auto &up : to_owner)
    {
      double *out = up.buffer.data();
      for (const unsigned int i : up.index)
        for (int d = 0; d < dim; ++d)
          *out++ = value[i][d] - before[i][d];
      start(MPI_Isend, up, tag_up);
    }
  MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);
  requests.clear();

  // The owner adds up in the order of the ranks, so that the result does not depend on timing.
  for (unsigned int s = 0; s < slot_sum.size(); ++s)
    slot_sum[s] =
      (slot_unknown[s] >= 0 ? value[slot_unknown[s]] - before[slot_unknown[s]] : Lanes<dim>{});
  for (const auto &down : from_users)
    for (unsigned int i = 0; i < down.index.size(); ++i)
      for (int d = 0; d < dim; ++d)
        slot_sum[down.index[i]][d] += down.buffer[dim * i + d];

  for (auto &up : to_owner)
    start(MPI_Irecv, up, tag_down);
  for (auto &down : from_users)
    {
      for (unsigned int i = 0; i < down.index.size(); ++i)
        for (int d = 0; d < dim; ++d)
          down.buffer[dim * i + d] = slot_sum[down.index[i]][d] / slot_count[down.index[i]];
      start(MPI_Isend, down, tag_down);
    }
  MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);

  for (const auto &up : to_owner)
    for (unsigned int i = 0; i < up.index.size(); ++i)
      for (int d = 0; d < dim; ++d)
        value[up.index[i]][d] = before[up.index[i]][d] + up.buffer[dim * i + d];
  for (unsigned int s = 0; s < slot_sum.size(); ++s)
    if (slot_unknown[s] >= 0)
      value[slot_unknown[s]] = before[slot_unknown[s]] + slot_sum[s] / double(slot_count[s]);
}

template class SharedUnknowns<2>;
template class SharedUnknowns<3>;
} // namespace coracle::contact

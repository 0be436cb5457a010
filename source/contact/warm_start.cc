// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/contact/messages.h>
#include <coracle/contact/warm_start.h>

#include <algorithm>
#include <tuple>

namespace coracle::contact
{
template <int dim>
std::size_t
WarmStart<dim>::place(const Key &key) const
{
  // The number of slots is a power of two; the multipliers spread consecutive ids.
  std::uint64_t hash = key.point * 0x9E3779B97F4A7C15ull + key.facet * 0xC2B2AE3D27D4EB4Full;
  hash ^= hash >> 29;
  return hash & (slots.size() - 1);
}

template <int dim>
dealii::Tensor<1, dim>
WarmStart<dim>::find(const Key &key) const
{
  if (!slots.empty())
    for (std::size_t i = place(key); slots[i].used; i = (i + 1) & (slots.size() - 1))
      if (slots[i].key.point == key.point && slots[i].key.facet == key.facet)
        return slots[i].impulse;
  return {};
}

template <int dim>
std::vector<dealii::Tensor<1, dim>>
WarmStart<dim>::find(const std::vector<Key> &keys) const
{
  std::vector<dealii::Tensor<1, dim>> result;
  result.reserve(keys.size());
  for (const Key &key : keys)
    result.push_back(find(key));
  return result;
}

// Contacts are few, and only those that had no impulse here, or were elsewhere, are asked for.
template <int dim>
std::vector<dealii::Tensor<1, dim>>
WarmStart<dim>::find_on_all_ranks(const std::vector<Key> &keys, MPI_Comm communicator) const
{
  const int n = n_ranks(communicator), me = my_rank(communicator);
  auto      result = find(keys);
  if (n == 1)
    return result;
  std::vector<std::vector<Key>> asked(n);
  std::vector<std::size_t>      missing;
  for (std::size_t k = 0; k < keys.size(); ++k)
    if (result[k].norm_square() == 0)
      missing.push_back(k);
  for (int r = 0; r < n; ++r)
    if (r != me)
      for (const std::size_t k : missing)
        asked[r].push_back(keys[k]);
  struct Found
  {
    std::size_t             place;
    std::array<double, dim> impulse;
  };
  std::vector<std::vector<Found>> answers(n);
  const auto                      questions = all_to_all(asked, communicator);
  for (int r = 0; r < n; ++r)
    for (std::size_t i = 0; i < questions[r].size(); ++i)
      if (const auto impulse = find(questions[r][i]); impulse.norm_square() > 0)
        {
          answers[r].push_back({i, {}});
          for (int d = 0; d < dim; ++d)
            answers[r].back().impulse[d] = impulse[d];
        }
  for (const auto &from_rank : all_to_all(answers, communicator))
    for (const Found &found : from_rank)
      for (int d = 0; d < dim; ++d)
        result[missing[found.place]][d] = found.impulse[d];
  return result;
}

template <int dim>
void
WarmStart<dim>::store(const std::vector<Key>                    &keys,
                      const std::vector<dealii::Tensor<1, dim>> &impulses)
{
  std::size_t size = std::max<std::size_t>(slots.size(), 16);
  while (size < 3 * keys.size())
    size *= 2;
  slots.resize(size);
  for (auto &slot : slots)
    slot.used = false;
  for (std::size_t k = 0; k < keys.size(); ++k)
    if (impulses[k].norm_square() > 0)
      {
        std::size_t i = place(keys[k]);
        while (slots[i].used)
          i = (i + 1) & (slots.size() - 1);
        slots[i] = {keys[k], impulses[k], true};
      }
}

template <int dim>
void
WarmStart<dim>::serialize(Archive &archive)
{
  // From a free slot on, so that entries of one key are met in the order in which they came; then
  // in an order that does not depend on how large the table has grown.
  std::vector<Slot> entries;
  std::size_t       first = 0;
  while (first < slots.size() && slots[first].used)
    ++first;
  for (std::size_t i = 0; i < slots.size() && !archive.loads(); ++i)
    if (const Slot &slot = slots[(first + i) % slots.size()]; slot.used)
      entries.push_back(slot);
  std::stable_sort(entries.begin(), entries.end(), [](const Slot &a, const Slot &b) {
    return std::tie(a.key.point, a.key.facet) < std::tie(b.key.point, b.key.facet);
  });
  std::vector<Key>                    keys;
  std::vector<dealii::Tensor<1, dim>> impulses;
  for (const Slot &slot : entries)
    {
      keys.push_back(slot.key);
      impulses.push_back(slot.impulse);
    }
  archive.all("keys", keys);
  archive.all("impulses", impulses);
  if (archive.loads())
    store(keys, impulses);
}

template class WarmStart<2>;
template class WarmStart<3>;
} // namespace coracle::contact

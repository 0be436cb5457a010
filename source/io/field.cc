// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/base/exceptions.h>

#include <coracle/io/field.h>

namespace coracle
{
std::vector<Field>
split_tensors(const std::vector<Field> &fields)
{
  static const char *const plane[] = {"_xx", "_yy", "_zz", "_xy"};
  static const char *const space[] = {"_xx", "_yy", "_zz", "_xy", "_yz", "_xz"};

  std::vector<Field> result;
  for (const Field &field : fields)
    {
      const auto n = field.components.size();
      Assert(n == 1 || n == 2 || n == 3 || n == 4 || n == 6,
             dealii::ExcMessage("Field '" + field.name +
                                "' has a number of components that is "
                                "neither a scalar's, a vector's nor a symmetric tensor's."));
      if (n <= 3)
        result.push_back(field);
      else
        for (unsigned int c = 0; c < n; ++c)
          result.push_back({field.name + (n == 4 ? plane : space)[c],
                            field.unit,
                            {field.components[c]},
                            field.stride,
                            field.exact});
    }
  return result;
}

template <typename Number>
std::vector<Number>
interleave(const Field &field, const std::size_t n, const std::vector<unsigned int> *indices)
{
  const unsigned int  n_components = n_written_components(field);
  std::vector<Number> result(n * n_components, Number(0));
  for (unsigned int c = 0; c < field.components.size(); ++c)
    {
      const double *const from = field.components[c];
      for (std::size_t i = 0; i < n; ++i)
        result[i * n_components + c] =
          static_cast<Number>(from[(indices ? (*indices)[i] : i) * field.stride]);
    }
  return result;
}

template std::vector<float>
interleave(const Field &, const std::size_t, const std::vector<unsigned int> *);
template std::vector<double>
interleave(const Field &, const std::size_t, const std::vector<unsigned int> *);
} // namespace coracle

// SPDX-License-Identifier: GPL-3.0-or-later
#include <coracle/base/parameter_declaration.h>
#include <coracle/material/library.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace coracle
{
namespace
{
template <typename F, std::size_t... i>
void
for_each_variant(const F &function, std::index_sequence<i...>)
{
  (function(static_cast<std::variant_alternative_t<i, MaterialVariant> *>(nullptr)), ...);
}

/// Call `function` with a null pointer to each model, in the order of the list.
template <typename F>
void
for_each_variant(const F &function)
{
  for_each_variant(function, std::make_index_sequence<std::variant_size_v<MaterialVariant>>());
}

/// The same once for each name: the list may hold a model twice (viscous or not).
template <typename F>
void
for_each_model(const F &function)
{
  std::vector<std::string> seen;
  for_each_variant([&](auto *model) {
    const std::string name = std::remove_pointer_t<decltype(model)>::name;
    if (std::find(seen.begin(), seen.end(), name) == seen.end())
      function(model);
    seen.push_back(name);
  });
}

MaterialVariant
read_material(const Parameters &parameters)
{
  std::optional<MaterialVariant> result;
  const std::string              chosen = parameters.choice("Model");
  for_each_variant([&](auto *model) {
    using Model = std::remove_pointer_t<decltype(model)>;
    if (!result && chosen == Model::name && Model::accepts(parameters))
      result.emplace(Model(parameters));
  });
  return result.value();
}
} // namespace

void
MaterialLibrary::declare(Declaration &root)
{
  Declaration &section =
    root.named_sections("Materials",
                        "material",
                        "What bodies are made of; bodies refer to these names");

  std::vector<std::string> names;
  std::string              meaning = "Constitutive model";
  for_each_model([&](auto *model) {
    using Model = std::remove_pointer_t<decltype(model)>;
    meaning +=
      std::string(names.empty() ? ": " : "; ") + Model::name + " (" + Model::description + ")";
    names.emplace_back(Model::name);
  });
  section.choice("Model", names.front(), names, meaning);

  for_each_model([&](auto *model) {
    using Model = std::remove_pointer_t<decltype(model)>;
    Model::declare(section.when("Model", Model::name));
  });
}

MaterialLibrary::MaterialLibrary(const Parameters &root)
{
  const Parameters section = root.section("Materials");
  for (const std::string &name : section.section_names())
    materials.emplace(name, read_material(section.section(name)));
}

const MaterialVariant &
MaterialLibrary::get(const std::string &name, const Parameters &asker) const
{
  const auto found = materials.find(name);
  if (found != materials.end())
    return found->second;

  std::vector<std::string> names;
  for (const auto &material : materials)
    names.push_back(material.first);
  throw asker.error("Material",
                    name.empty() ? "body without a material" : "unknown material",
                    name.empty() ? "no name" : "'" + name + "'",
                    names.empty() ? "add a subsection to Materials that describes it"
                                  : internal::suggest(name, names));
}
} // namespace coracle

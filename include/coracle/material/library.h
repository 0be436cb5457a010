// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <coracle/material/fluid.h>
#include <coracle/material/linear_elastic.h>
#include <coracle/material/neo_hookean.h>
#include <coracle/material/tait.h>
#include <coracle/material/weakly_compressible.h>

#include <map>
#include <string>
#include <variant>

namespace coracle
{
/**
 * Every constitutive model. To add one, write its header (see motion.h for its
 * form), include it above and name it here: parameter files, elements and
 * particles then know it.
 */
using MaterialVariant = std::variant<Fluid<WeaklyCompressible, false>,
                                     Fluid<WeaklyCompressible, true>,
                                     Fluid<Tait, false>,
                                     Fluid<Tait, true>,
                                     LinearElastic,
                                     NeoHookean>;

/**
 * The materials of a case, by the names that its parameter file gives them.
 * Bodies look theirs up once; their kernels visit the variant once a step.
 */
class MaterialLibrary
{
public:
  /// The section `Materials`, any number of named materials.
  static void declare(Declaration &root);

  explicit MaterialLibrary(const Parameters &root);

  /**
   * The material that the section `asker` names in its entry `Material`.
   * Throws a UserError that suggests the nearest name and lists those there are.
   */
  const MaterialVariant &get(const std::string &name, const Parameters &asker) const;

private:
  std::map<std::string, MaterialVariant> materials;
};
} // namespace coracle

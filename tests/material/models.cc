// SPDX-License-Identifier: GPL-3.0-or-later
// The stress of every model with a stored energy is that energy's derivative, its sound speed the
// root of the pressure's, and a pack gives what its lanes give one by one.

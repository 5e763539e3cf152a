/// The pointwise part of a stage, unrolled from the integrator table: the only code that executes its
/// assignments on the host. Text without an include guard, because vector code compiles it once per
/// instruction set, inside a namespace of that set. The includer defines MSSIM_INLINE and, for its `Vector`
/// and `Real`,
///   mul_add(Real, Vector, Vector), Vector + Vector, Real * Vector,
/// and has included integrators/coefficients.h.

/// One assignment: the sum of its terms, the last first, so the large first term is added last. A sum of two
/// terms is rounded once if mul_add is.
template <std::size_t row, std::size_t stage, std::size_t assignment, bool in_steps, class Vector, class Real>
MSSIM_INLINE Vector sum_terms(const Vector* value, const Coefficients<Real>& coefficients) {
  constexpr Assignment terms = integrators[row].stages[stage].assignments[assignment];
  constexpr std::size_t count = term_count(terms);
  const auto& factor = coefficients[stage][assignment];
  static_assert(count == 1 || (terms.terms[0].coefficient == 1 && terms.terms[0].dt_power == 0),
                "the large term is a plain one");
  // Equals a product with 1, but saves the multiplication.
  if constexpr (count == 2 && in_steps && terms.terms[1].coefficient == 1)
    return value[index(terms.terms[0].slot)] + value[index(terms.terms[1].slot)];
  else if constexpr (count == 2)
    return mul_add(factor[1], value[index(terms.terms[1].slot)], value[index(terms.terms[0].slot)]);
  Vector sum = factor[count - 1] * value[index(terms.terms[count - 1].slot)];
  if constexpr (count > 4) sum = mul_add(factor[3], value[index(terms.terms[3].slot)], sum);
  if constexpr (count > 3) sum = mul_add(factor[2], value[index(terms.terms[2].slot)], sum);
  if constexpr (count > 2) sum = mul_add(factor[1], value[index(terms.terms[1].slot)], sum);
  if constexpr (count > 1) sum = value[index(terms.terms[0].slot)] + sum;
  return sum;
}

/// All assignments of a stage at one node (or one vector of nodes). load(slot) -> Vector reads memory,
/// store(slot, Vector) writes it, contact(x, v) acts on the new state at the end of the last stage. `x` and
/// `v` are the gathered pair's values, `a` is the acceleration at them. `in_steps`: dt is the unit of time,
/// and the coefficients are those of dt = 1.
template <std::size_t row, std::size_t stage, bool in_steps = false, class Vector, class Real, class Load,
          class Store, class Contact>
MSSIM_INLINE void update_stage(const Coefficients<Real>& coefficients, const Vector& x, const Vector& v,
                               const Vector& a, Load load, Store store, Contact contact) {
  constexpr Stage table = integrators[row].stages[stage];
  constexpr std::size_t assignments = assignment_count(table);
  Vector value[slot_kinds];
  const auto fetch = [&]<std::size_t i>(std::integral_constant<std::size_t, i>) MSSIM_INLINE_LAMBDA {
    constexpr Slot slot = static_cast<Slot>(i);
    if constexpr (reads(table, slot) && slot != position_slot(table.gather) &&
                  slot != velocity_slot(table.gather))
      value[i] = load(std::integral_constant<Slot, slot>{});
  };
  const auto flush = [&]<std::size_t i>(std::integral_constant<std::size_t, i>) MSSIM_INLINE_LAMBDA {
    constexpr Slot slot = static_cast<Slot>(i);
    if constexpr (writes(table, slot)) store(std::integral_constant<Slot, slot>{}, value[i]);
  };
  [&]<std::size_t... i>(std::index_sequence<i...>) MSSIM_INLINE_LAMBDA {
    (fetch(std::integral_constant<std::size_t, i>{}), ...);
  }
  (std::make_index_sequence<memory_slots>{});
  value[index(position_slot(table.gather))] = x;
  value[index(velocity_slot(table.gather))] = v;
  value[index(Slot::a)] = a;
  [&]<std::size_t... l>(std::index_sequence<l...>) MSSIM_INLINE_LAMBDA {
    ((value[index(table.assignments[l].out)] = sum_terms<row, stage, l, in_steps>(value, coefficients)), ...);
  }
  (std::make_index_sequence<assignments>{});
  if constexpr (stage + 1 == integrators[row].stage_count)
    contact(value[index(Slot::x_next)], value[index(Slot::v_next)]);
  [&]<std::size_t... i>(std::index_sequence<i...>) MSSIM_INLINE_LAMBDA {
    (flush(std::integral_constant<std::size_t, i>{}), ...);
  }
  (std::make_index_sequence<memory_slots>{});
}

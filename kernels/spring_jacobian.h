/* The Jacobian of a spring's force (spring_law.h) as a matrix, along n n^T + across (I - n n^T), and sums of
 * such matrices, written once in the common subset of C++ and OpenCL C.
 *
 * Text for many number types like node_laws.h.
 */

/* A symmetric 3 x 3 matrix: the diagonal block of a node in a stiffness matrix, or its inverse.
 */
MSSIM_STRUCT(SymmetricBlock) { Real xx, xy, xz, yy, yz, zz; };

MSSIM_GIVES(SymmetricBlock) block_sum(MSSIM_OF(SymmetricBlock) a, MSSIM_OF(SymmetricBlock) b) {
  MSSIM_OF(SymmetricBlock) sum;
  sum.xx = a.xx + b.xx;
  sum.xy = a.xy + b.xy;
  sum.xz = a.xz + b.xz;
  sum.yy = a.yy + b.yy;
  sum.yz = a.yz + b.yz;
  sum.zz = a.zz + b.zz;
  return sum;
}

MSSIM_VECTOR_LAW block_times(MSSIM_OF(SymmetricBlock) block, Vector p) {
  Vector product = {mul_add(block.xx, p.x, mul_add(block.xy, p.y, block.xz * p.z)),
                    mul_add(block.xy, p.x, mul_add(block.yy, p.y, block.yz * p.z)),
                    mul_add(block.xz, p.x, mul_add(block.yz, p.y, block.zz * p.z))};
  return product;
}

MSSIM_GIVES(SymmetricBlock) block_scaled(Real factor, MSSIM_OF(SymmetricBlock) block) {
  MSSIM_OF(SymmetricBlock) scaled;
  scaled.xx = factor * block.xx;
  scaled.xy = factor * block.xy;
  scaled.xz = factor * block.xz;
  scaled.yy = factor * block.yy;
  scaled.yz = factor * block.yz;
  scaled.zz = factor * block.zz;
  return scaled;
}

/* Inverts by cofactors. The block must be positive definite; in single precision its eigenvalues may differ
 * by a factor of 1e5, and its trace must be between 2^-100 and 2^110. */
MSSIM_GIVES(SymmetricBlock) block_inverse(MSSIM_OF(SymmetricBlock) block) {
  MSSIM_OF(SymmetricBlock) cofactors;
  Real one = block.xx - block.xx + 1.0f;
  /* Single precision can only hold the determinant of a block near 1. A power of two changes no digit. */
  Real trace = block.xx + block.yy + block.zz;
  Real least = one * 0x1p-30f, most = one * 0x1p40f;
  Real unit = where_less(trace, least, one * 0x1p70f, where_less(most, trace, one * 0x1p-70f, one));
  block = block_scaled(unit, block);
  cofactors.xx = block.yy * block.zz - block.yz * block.yz;
  cofactors.xy = block.xz * block.yz - block.xy * block.zz;
  cofactors.xz = block.xy * block.yz - block.xz * block.yy;
  cofactors.yy = block.xx * block.zz - block.xz * block.xz;
  cofactors.yz = block.xy * block.xz - block.xx * block.yz;
  cofactors.zz = block.xx * block.yy - block.xy * block.xy;
  Real determinant =
      mul_add(block.xx, cofactors.xx, mul_add(block.xy, cofactors.xy, block.xz * cofactors.xz));
  return block_scaled(unit, block_scaled(one / determinant, cofactors));
}

/* [along n n^T + across (I - n n^T)] p; n: a unit vector. */
MSSIM_VECTOR_LAW spring_jacobian_times(Vector n, Real along, Real across, Vector p) {
  Real part = (along - across) * dot_product(n, p);
  Vector product = {mul_add(part, n.x, across * p.x), mul_add(part, n.y, across * p.y),
                    mul_add(part, n.z, across * p.z)};
  return product;
}

/* The matrix along n n^T + across (I - n n^T) itself. */
MSSIM_GIVES(SymmetricBlock) spring_jacobian(Real nx, Real ny, Real nz, Real along, Real across) {
  MSSIM_OF(SymmetricBlock) block;
  Real difference = along - across;
  Real x = difference * nx, y = difference * ny, z = difference * nz;
  block.xx = mul_add(x, nx, across);
  block.xy = x * ny;
  block.xz = x * nz;
  block.yy = mul_add(y, ny, across);
  block.yz = y * nz;
  block.zz = mul_add(z, nz, across);
  return block;
}

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

/* Inverts by cofactors. The block must be positive definite; in single precision its eigenvalues may differ
 * by a factor of 1e5. */
MSSIM_GIVES(SymmetricBlock) block_inverse(MSSIM_OF(SymmetricBlock) block) {
  MSSIM_OF(SymmetricBlock) inverse;
  Real one = block.xx - block.xx + 1.0f;
  Real xx = block.yy * block.zz - block.yz * block.yz;
  Real xy = block.xz * block.yz - block.xy * block.zz;
  Real xz = block.xy * block.yz - block.xz * block.yy;
  Real scale = one / mul_add(block.xx, xx, mul_add(block.xy, xy, block.xz * xz));
  inverse.xx = scale * xx;
  inverse.xy = scale * xy;
  inverse.xz = scale * xz;
  inverse.yy = scale * (block.xx * block.zz - block.xz * block.xz);
  inverse.yz = scale * (block.xy * block.xz - block.xx * block.yz);
  inverse.zz = scale * (block.xx * block.yy - block.xy * block.xy);
  return inverse;
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

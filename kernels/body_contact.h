/* Contact of a point of cloth with a body that is described by maps (parameters.h), in the common subset of
 * C++ and OpenCL C: the test of one point against the tangent planes of its pixel, and the response.
 *
 * Within a pixel, the body is the set of points behind both planes. A plane tangent to the front or back face
 * is a far better bound than the face's depth, which is a staircase: the signed distance from the plane is
 * continuous within a pixel and nearly so across its edge.
 *
 * Text for many number types like spring_law.h; include it after node_laws.h (for floor_grip, Coulomb's law).
 */

/* The record of a pixel: for each plane, the unit normal n, which points out of the body, and n . P (m). */
MSSIM_STRUCT(BodyPlanes) {
  Real front_x, front_y, front_z, front_at;
  Real back_x, back_y, back_z, back_at;
};

/* Contact of a point with the body: the signed distance from the nearer plane (m, negative inside, 1e30 if
 * there is no body) and that plane's normal. The body lies behind both planes, so the larger distance is the
 * nearer plane's. */
MSSIM_STRUCT(BodyContact) { Real distance, x, y, z; };

/* A point of cloth before a step: its position (m) and the velocity (m/s) that would move it. */
MSSIM_STRUCT(ClothPoint) { Real x, y, z, u, v, w; };

/* The point after the response. stuck: 1 if friction removes all of the velocity along the body, else 0. */
MSSIM_STRUCT(ClothResponse) { Real x, y, z, u, v, w, stuck; };

/* Column (or row) of a coordinate, not yet truncated to a whole number; last: the number of the last column.
 * Outside the maps, and for NaN, it is a column of the border. */
MSSIM_LAW body_column(Real coordinate, Real first, Real pixels_per_metre, Real last) {
  Real column = (coordinate - first) * pixels_per_metre;
  Real none = last - last;
  /* Keep this order: NaN is not less than `last`. */
  column = where_less(column, last, column, last);
  return where_less(column, none, none, column);
}

MSSIM_GIVES(BodyContact) body_contact(MSSIM_OF(BodyPlanes) planes, Real x, Real y, Real z) {
  Real front =
      mul_add(planes.front_x, x, mul_add(planes.front_y, y, mul_add(planes.front_z, z, -planes.front_at)));
  Real back =
      mul_add(planes.back_x, x, mul_add(planes.back_y, y, mul_add(planes.back_z, z, -planes.back_at)));
  MSSIM_OF(BodyContact) contact;
  contact.distance = where_less(front, back, back, front);
  contact.x = where_less(front, back, planes.back_x, planes.front_x);
  contact.y = where_less(front, back, planes.back_y, planes.front_y);
  contact.z = where_less(front, back, planes.back_z, planes.front_z);
  return contact;
}

/* Response of a point to the body. `contact` is the contact of the position after the step, x + dt v. If that
 * is inside, the velocity into the body is removed, and the velocity along it loses at most friction times
 * what was removed (floor_grip). The remaining depth is then taken out of the position, by at most push_speed
 * times dt: a push by velocity would be motion in the next step, and the point would jitter for ever. A point
 * that leaves the body keeps its velocity. */
MSSIM_GIVES(ClothResponse)
body_response(MSSIM_OF(ClothPoint) point, MSSIM_OF(BodyContact) contact, Real friction, Real push_speed,
              Real dt) {
  Real none = dt - dt;
  Real one = none + 1.0f;
  Real outwards = mul_add(contact.x, point.u, mul_add(contact.y, point.v, contact.z * point.w));
  Real dropped = where_less(outwards, none, -outwards, none);
  dropped = where_less(contact.distance, none, dropped, none);
  Real u = mul_add(dropped, contact.x, point.u);
  Real v = mul_add(dropped, contact.y, point.v);
  Real w = mul_add(dropped, contact.z, point.w);
  Real kept = floor_grip(dropped, mul_add(u, u, mul_add(v, v, w * w)), friction);
  /* If nothing was removed, the velocity may point out of the body and is kept whole: floor_grip is 1. */
  Real depth = -mul_add(dropped, dt, contact.distance);
  Real most = push_speed * dt;
  depth = where_less(most, depth, most, depth);
  Real push = where_less(none, depth, depth, none);
  MSSIM_OF(ClothResponse) after;
  after.x = mul_add(push, contact.x, point.x);
  after.y = mul_add(push, contact.y, point.y);
  after.z = mul_add(push, contact.z, point.z);
  after.u = kept * u;
  after.v = kept * v;
  after.w = kept * w;
  after.stuck = where_less(none, kept, none, one);
  return after;
}

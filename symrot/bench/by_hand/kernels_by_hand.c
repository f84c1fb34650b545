/* Kernels as one writes them by hand, with care; symrot.bench.kernels compiles them with the flags of its own. */
#include <math.h>

static inline void symrot_quaternion_dcm(const double q[4], double dcm[9])
{
    const double x = 2.0*q[1];
    const double y = 2.0*q[2];
    const double z = 2.0*q[3];
    const double xx = q[1]*x;
    const double xy = q[1]*y;
    const double xz = q[1]*z;
    const double yy = q[2]*y;
    const double yz = q[2]*z;
    const double zz = q[3]*z;
    const double wx = q[0]*x;
    const double wy = q[0]*y;
    const double wz = q[0]*z;
    dcm[0] = 1.0 - (yy + zz);
    dcm[1] = xy - wz;
    dcm[2] = xz + wy;
    dcm[3] = xy + wz;
    dcm[4] = 1.0 - (xx + zz);
    dcm[5] = yz - wx;
    dcm[6] = xz - wy;
    dcm[7] = yz + wx;
    dcm[8] = 1.0 - (xx + yy);
}

static inline void symrot_euler_zxz_body_rates(const double angles[3], const double omega[3], double dangles[3])
{
    const double s = sin(angles[2]);
    const double c = cos(angles[2]);
    const double turning = (omega[0]*s + omega[1]*c)/sin(angles[1]);
    dangles[0] = turning;
    dangles[1] = omega[0]*c - omega[1]*s;
    dangles[2] = omega[2] - turning*cos(angles[1]);
}

static inline void symrot_euler_zyx_body_rates(const double angles[3], const double omega[3], double dangles[3])
{
    const double s = sin(angles[2]);
    const double c = cos(angles[2]);
    const double turning = (omega[1]*s + omega[2]*c)/cos(angles[1]);
    dangles[0] = turning;
    dangles[1] = omega[1]*c - omega[2]*s;
    dangles[2] = omega[0] + turning*sin(angles[1]);
}

static inline void symrot_rigid_body_tensor(
    const double inertia[6], const double omega[3], const double q[4], const double torque[3], double domega[3],
    double dq[4])
{
    const double xx = inertia[0];
    const double yy = inertia[1];
    const double zz = inertia[2];
    const double xy = inertia[3];
    const double xz = inertia[4];
    const double yz = inertia[5];
    const double l1 = xx*omega[0] + xy*omega[1] + xz*omega[2];
    const double l2 = xy*omega[0] + yy*omega[1] + yz*omega[2];
    const double l3 = xz*omega[0] + yz*omega[1] + zz*omega[2];
    const double c11 = yy*zz - yz*yz;
    const double c12 = xz*yz - xy*zz;
    const double c13 = xy*yz - xz*yy;
    const double c22 = xx*zz - xz*xz;
    const double c23 = xy*xz - xx*yz;
    const double c33 = xx*yy - xy*xy;
    const double over = 1.0/(xx*c11 + xy*c12 + xz*c13);
    const double m1 = (torque[0] - omega[1]*l3 + omega[2]*l2)*over;
    const double m2 = (torque[1] - omega[2]*l1 + omega[0]*l3)*over;
    const double m3 = (torque[2] - omega[0]*l2 + omega[1]*l1)*over;
    domega[0] = c11*m1 + c12*m2 + c13*m3;
    domega[1] = c12*m1 + c22*m2 + c23*m3;
    domega[2] = c13*m1 + c23*m2 + c33*m3;
    const double x = 0.5*omega[0];
    const double y = 0.5*omega[1];
    const double z = 0.5*omega[2];
    dq[0] = -(x*q[1] + y*q[2] + z*q[3]);
    dq[1] = x*q[0] + z*q[2] - y*q[3];
    dq[2] = y*q[0] + x*q[3] - z*q[1];
    dq[3] = z*q[0] + y*q[1] - x*q[2];
}

static inline void symrot_heavy_top(
    const double inertia[3], double weight, const double center_of_mass[3], const double omega[3], const double q[4],
    double domega[3], double dq[4])
{
    const double a = inertia[0];
    const double b = inertia[1];
    const double c = inertia[2];
    const double twice = 2.0*weight;
    const double u1 = twice*center_of_mass[0];
    const double u2 = twice*center_of_mass[1];
    const double u3 = twice*center_of_mass[2];
    const double g1 = q[1]*q[3] - q[0]*q[2];
    const double g2 = q[2]*q[3] + q[0]*q[1];
    const double g3 = 0.5 - q[1]*q[1] - q[2]*q[2];
    domega[0] = ((b - c)*omega[1]*omega[2] + g2*u3 - g3*u2)/a;
    domega[1] = ((c - a)*omega[2]*omega[0] + g3*u1 - g1*u3)/b;
    domega[2] = ((a - b)*omega[0]*omega[1] + g1*u2 - g2*u1)/c;
    const double x = 0.5*omega[0];
    const double y = 0.5*omega[1];
    const double z = 0.5*omega[2];
    dq[0] = -(x*q[1] + y*q[2] + z*q[3]);
    dq[1] = x*q[0] + z*q[2] - y*q[3];
    dq[2] = y*q[0] + x*q[3] - z*q[1];
    dq[3] = z*q[0] + y*q[1] - x*q[2];
}

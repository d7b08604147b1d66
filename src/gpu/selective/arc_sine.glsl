// The arc sine for 0 <= x <= 1, because GLSL has none for double. The rational form of Sun's fdlibm; the error is below
// 1e-15.
double asin(double x) {
    const bool small = x < 0.5lf;
    precise const double t = small ? x * x : (1 - x) * 0.5lf;
    precise const double above =
        t * (1.66666666666666657415e-01lf +
             t * (-3.25565818622400915405e-01lf +
                  t * (2.01212532134862925881e-01lf +
                       t * (-4.00555345006794114027e-02lf +
                            t * (7.91534994289814532176e-04lf + t * 3.47933107596021167570e-05lf)))));
    precise const double below =
        1 + t * (-2.40339491173441421878e+00lf +
                 t * (2.02094576023350569471e+00lf +
                      t * (-6.88283971605453293030e-01lf + t * 7.70381505559019352791e-02lf)));
    const double s = small ? x : sqrt(t);
    precise const double bent = s + s * (above / below);
    precise const double angle = small ? bent : 3.141592653589793lf / 2 - 2 * bent;
    return angle;
}

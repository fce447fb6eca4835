/* keep_drivers.c: part of executables built with sanitizers only.
 *
 * The OpenCL loader closes its drivers when a program ends, before the leak check runs: what a driver's
 * globals point at then looks lost, and its frames have no names that a suppression could match. So libraries
 * stay. */
int dlclose(void *handle);
int dlclose(void *handle) {
    (void)handle;
    return 0;
}

/* libmodbus_client HOST PORT COUNT: reads register 0 so often over Modbus TCP; prints the seconds that took. */
#include <modbus/modbus.h>
#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return time.tv_sec + time.tv_nsec / 1e9;
}

int main(int argc, char **argv)
{
    if (argc != 4)
        return 2;
    modbus_t *modbus = modbus_new_tcp(argv[1], atoi(argv[2]));
    if (!modbus || modbus_set_slave(modbus, 1) < 0 || modbus_connect(modbus) < 0) {
        fprintf(stderr, "not connected\n");
        return 1;
    }
    uint16_t value;
    double started = now();
    for (long left = atol(argv[3]); left > 0; left--)
        if (modbus_read_registers(modbus, 0, 1, &value) != 1) {
            fprintf(stderr, "%s\n", modbus_strerror(errno));
            return 1;
        }
    printf("%.6f\n", now() - started);
    return 0;
}

/* A neighbour of another version: publishes slammot/odometry of the vehicle "car" until it is ended.
   Usage: neighbour DOMAIN CONFIG; compiled once for each version. */
#include <dds/dds.h>
#include <stdlib.h>
#include <string.h>

#include VERSION_HEADER

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const dds_domainid_t domain = (dds_domainid_t)atoi(argv[1]);
  if (dds_create_domain(domain, argv[2]) < 0) return 1;
  const dds_entity_t participant = dds_create_participant(domain, NULL, NULL);
  const dds_entity_t topic =
      dds_create_topic(participant, &slammot_Odometry_desc, "slammot/odometry", NULL, NULL);
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_destination_order(qos, DDS_DESTINATIONORDER_BY_RECEPTION_TIMESTAMP);
  const dds_entity_t writer = dds_create_writer(participant, topic, qos, NULL);
  dds_delete_qos(qos);
  if (writer < 0) return 1;
  slammot_Odometry sample;
  memset(&sample, 0, sizeof sample);
  strcpy(sample.vehicle_id, "car");
  sample.STAMP = 1500000000;
  for (;;) {
    dds_write(writer, &sample);
    dds_sleepfor(DDS_MSECS(20));
  }
}

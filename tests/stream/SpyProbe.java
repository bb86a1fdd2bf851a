package lcm.spy;

import java.util.ArrayList;
import java.util.TreeMap;

/**
 * SpyProbe URL CHANNEL=TYPE...: runs lcm-spy and reads its own table. Ends with 0 as soon as every channel has been
 * decoded at least twice as its type and nothing was undecodable, with 1 if that does not happen within 30 seconds.
 * In lcm-spy's package, since the table is only visible there.
 */
public class SpyProbe {
  public static void main(String[] arguments) throws Exception {
    TreeMap<String, String> expected = new TreeMap<>();
    for (int i = 1; i < arguments.length; ++i) {
      String[] parts = arguments[i].split("=");
      expected.put(parts[0], parts[1]);
    }
    Spy spy = new Spy(arguments[0]);
    boolean fine = false;
    for (int i = 0; i < 300 && !fine; ++i) {
      Thread.sleep(100);
      fine = isFine(copyOf(spy), expected);
    }
    for (ChannelData channel : copyOf(spy)) {
      String type = channel.cls == null ? "unknown" : channel.cls.getName();
      System.out.printf("%s %s: received %d, undecodable %d%n", channel.name, type, channel.nreceived, channel.nerrors);
    }
    if (fine) Thread.sleep(2000);  // for the picture that the script takes of the window
    System.exit(fine ? 0 : 1);
  }

  private static ArrayList<ChannelData> copyOf(Spy spy) {
    synchronized (spy.channelList) {
      return new ArrayList<>(spy.channelList);
    }
  }

  private static boolean isFine(ArrayList<ChannelData> channels, TreeMap<String, String> expected) {
    TreeMap<String, String> found = new TreeMap<>();
    for (ChannelData channel : channels) {
      if (channel.nerrors != 0) return false;
      if (channel.last != null && channel.nreceived >= 2) found.put(channel.name, channel.last.getClass().getName());
    }
    return found.equals(expected);
  }
}

// Ticks a tree with actions of ours in a BehaviorTree.CPP before 4.6, 3.8 among them, and tells what its nodes went through.
//
// Those have no JSON to share: the job is text on standard input, see engine_loader.py; the answer is that of main.cpp.
#if __has_include(<behaviortree_cpp_v3/bt_factory.h>)
#include <behaviortree_cpp_v3/bt_factory.h>
using Config = BT::NodeConfiguration;
#else
#include <behaviortree_cpp/bt_factory.h>
using Config = BT::NodeConfig;
#endif

#include <unistd.h>

#include <chrono>
#include <iostream>
#include <iterator>
#include <sstream>
#include <thread>

using BT::NodeStatus;
using Activations = std::vector<std::vector<NodeStatus>>;

namespace
{
// What an action does: a list of activations, each a status a tick; the last one of each list is repeated.
struct Stub : BT::StatefulActionNode
{
  Stub(const std::string& name, const Config& config, const Activations& activations)
    : StatefulActionNode(name, config), activations_(activations)
  {}
  NodeStatus onStart() override
  {
    return onRunning();
  }
  NodeStatus onRunning() override
  {
    const auto& steps = activations_.at(std::min(activation_, activations_.size() - 1));
    const NodeStatus status = steps.at(std::min(step_++, steps.size() - 1));
    if(status != NodeStatus::RUNNING)
      onHalted();
    return status;
  }
  void onHalted() override
  {
    activation_++;
    step_ = 0;
  }
  Activations activations_;
  size_t activation_ = 0;
  size_t step_ = 0;
};

// One tick: 4.1 and later may do more where a node asks for it, unless told not to.
template <typename Tree>
auto tick(Tree& tree, int) -> decltype(tree.tickExactlyOnce())
{
  return tree.tickExactlyOnce();
}
template <typename Tree>
auto tick(Tree& tree, long) -> decltype(tree.tickRoot())
{
  return tree.tickRoot();
}
template <typename Tree>
auto tick(Tree& tree, ...) -> decltype(tree.tickOnce())
{
  return tree.tickOnce();
}

std::string inJson(const std::string& text)
{
  std::string found = "\"";
  for(const char each : text)
  {
    if(each == '"' || each == '\\')
      found += '\\';
    found += each < ' ' ? ' ' : each;
  }
  return found + '"';
}
}  // namespace

int main()
{
  std::string line, word, ID;
  int ticks = 0, tick_ms = 0;
  std::map<std::string, Activations> parts;
  BT::BehaviorTreeFactory factory;
  while(std::getline(std::cin, line) && !line.empty())
  {
    std::istringstream words(line);
    words >> word;
    if(word == "ticks")
      words >> ticks >> tick_ms;
    else if(word == "stub" && words >> ID)
      factory.registerBuilder(BT::TreeNodeManifest{ BT::NodeType::ACTION, ID, {}, {} },
                              [&parts](const std::string& name, const Config& config) {
                                const auto part = parts.find(name);
                                const Activations usual = { { NodeStatus::RUNNING, NodeStatus::SUCCESS } };
                                return std::make_unique<Stub>(name, config, part == parts.end() ? usual : part->second);
                              });
    else if(word == "part" && words >> ID)
    {
      Activations& part = parts[ID] = { {} };
      while(words >> word)
      {
        if(word == "/")
          part.emplace_back();
        else
          part.back().push_back(BT::convertFromString<NodeStatus>(word));
      }
    }
  }
  const std::string xml(std::istreambuf_iterator<char>(std::cin), {});

  std::string nodes, transitions, error, stage = "load";
  NodeStatus status = NodeStatus::IDLE;
  int ticked = 0;
  try
  {
    BT::Tree tree = factory.createTreeFromText(xml);
    stage = "tick";
    std::vector<BT::TreeNode::StatusChangeSubscriber> subscribers;
    BT::applyRecursiveVisitor(tree.rootNode(), [&](BT::TreeNode* node) {
      const std::string uid = std::to_string(node->UID());
      nodes += (nodes.empty() ? "" : ",") + ("{\"uid\":" + uid) + ",\"name\":" + inJson(node->name()) +
               ",\"ID\":" + inJson(node->registrationName()) +
               R"(,"path":"","parent":0,"inputs":{},"outputs":{},"conditions":{}})";
      subscribers.push_back(node->subscribeToStatusChange(
          [&, uid](BT::TimePoint, const BT::TreeNode&, NodeStatus before, NodeStatus after) {
            transitions += (transitions.empty() ? "[" : ",[") + std::to_string(ticked) + ',' + uid + ',' +
                           inJson(BT::toStr(before)) + ',' + inJson(BT::toStr(after)) + ']';
          }));
    });
    while(ticked < ticks)
    {
      ticked++;
      status = tick(tree, 0);
      if(status != NodeStatus::RUNNING)
        break;
      std::this_thread::sleep_for(std::chrono::milliseconds(tick_ms));
    }
    stage = "done";
  }
  catch(const std::exception& thrown)
  {
    error = thrown.what();
  }
  std::cout << "\x1e{\"stage\":" << inJson(stage) << ",\"error\":" << inJson(error)
            << ",\"status\":" << inJson(BT::toStr(status)) << ",\"ticks\":" << ticked
            << ",\"trees\":[{\"ID\":\"\",\"nodes\":[" << nodes << "]}],\"transitions\":[" << transitions << "]}"
            << std::endl;
  return 0;
}
